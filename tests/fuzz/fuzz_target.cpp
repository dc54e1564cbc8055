/// The entry point of libFuzzer; ROUTEBENCH_FUZZ_ENTRY names what it calls.

#include <cstddef>
#include <cstdint>

#include "entries.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  routebench::fuzz::ROUTEBENCH_FUZZ_ENTRY({reinterpret_cast<const char*>(data), size});
  return 0;
}
