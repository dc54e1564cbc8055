#pragma once
/// Random numbers that are the same everywhere.

#include <cstdint>

namespace routebench::shapes {

/// The SplitMix64 generator; the standard library's distributions differ between libraries.
/// Source: G. Steele, D. Lea, C. Flood, 2014.
class Random {
 public:
  explicit Random(std::uint64_t seed) noexcept : state_(seed) {}

  std::uint64_t next() noexcept {
    state_ += 0x9E3779B97F4A7C15U;
    std::uint64_t z = state_;
    z = (z ^ (z >> 30U)) * 0xBF58476D1CE4E5B9U;
    z = (z ^ (z >> 27U)) * 0x94D049BB133111EBU;
    return z ^ (z >> 31U);
  }
  /// In [0, count); the bias is below count / 2^64.
  std::uint64_t below(std::uint64_t count) noexcept { return next() % count; }
  /// In [low, high).
  double between(double low, double high) noexcept {
    return low + (high - low) * (static_cast<double>(next() >> 11U) / 9007199254740992.0);
  }

 private:
  std::uint64_t state_;
};

}  // namespace routebench::shapes
