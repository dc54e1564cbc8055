#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "large_vector.hpp"
#include "model/blocks.hpp"
#include "model/facet_sink.hpp"
#include "model/join_parts.hpp"
#include "model/stl_reader.hpp"

namespace routebench::models {
namespace {

static_assert(std::endian::native == std::endian::little, "binary STL is little-endian");

constexpr std::size_t kHeaderBytes = 84;
constexpr std::size_t kFacetBytes = 50;
constexpr std::size_t kNormalBytes = 12;
/// How far ahead bytes are asked for: the processor does it by itself, but not past a page's end.
constexpr std::size_t kBytesAhead = 2048;

std::uint32_t count_field(std::span<const char> bytes) {
  std::uint32_t count = 0;
  std::memcpy(&count, bytes.data() + kHeaderBytes - sizeof count, sizeof count);
  return count;
}

/// How many facets to read, and what to say about it.
struct Extent {
  std::size_t facets = 0;
  std::string warning;  ///< empty if the file is as it should be
};

Extent extent_of(std::span<const char> bytes, const ReadContext& context) {
  const std::size_t body = bytes.size() - kHeaderBytes;
  const std::size_t held = body / kFacetBytes;
  const std::size_t rest = body % kFacetBytes;
  const std::size_t count = count_field(bytes);
  if (count == held && rest == 0) return {held, ""};

  const std::string claim = "the count field says " + counted(count, "facet");
  // Writers that stream leave the field at 0 or -1; then the file's size decides.
  const bool unset = count == 0 || count == 0xFFFFFFFFU;
  if (rest != 0 && (unset || count > held)) {
    const std::string cut = "cut short: the file ends inside facet " + std::to_string(held + 1) +
                            (unset ? "" : " of " + std::to_string(count)) + ", at byte " +
                            std::to_string(bytes.size());
    if (!context.repair) {
      refuse_model(context.name, cut + "; with --repair the whole facets are read");
    }
    return {held, cut + "; " + counted(held, "whole facet") + " read"};
  }
  if (count > held && !unset) {
    const std::string cut = "cut short: " + claim + ", the file holds " + std::to_string(held);
    if (!context.repair) {
      refuse_model(context.name, cut + "; with --repair these are read");
    }
    return {held, cut};
  }
  if (rest == 0) {
    return {held,
            claim + ", but the file holds exactly " + std::to_string(held) + "; all of them read"};
  }
  return {count, counted(bytes.size() - kHeaderBytes - count * kFacetBytes, "byte") +
                     " after the last of " + counted(count, "facet") + " not looked at"};
}

}  // namespace

RawMesh read_binary_stl(std::span<const char> bytes, const ReadContext& context) {
  if (bytes.size() < kHeaderBytes) {
    refuse_model(context.name, "not an STL file: " + counted(bytes.size(), "byte") +
                                   " are less than the 84 of a binary header");
  }
  const Extent extent = extent_of(bytes, context);
  if (extent.facets == 0) refuse_model(context.name, "a binary STL file without any facet");
  refuse_too_many_triangles(context.name, extent.facets);

  RawMesh raw;
  raw.single_precision = true;
  auto& triangles = raw.mesh.triangles;
  resize_large(triangles, extent.facets, context.parallel_for);
  std::vector<WeldedPart> parts(block_count(extent.facets));
  // Calls add(sink, facets, offset of the first) for facets [begin, end).
  const auto fill_sink = [&](std::size_t begin, std::size_t end, const auto& add) {
    const auto room = [to = triangles.data() + begin](std::size_t count) mutable {
      return std::exchange(to, to + count);
    };
    FacetSink sink(context, room, end - begin, begin);
    std::array<Facet, FacetSink::kFacetsAtOnce> facets;  // written before it is read
    for (std::size_t first = begin; first < end; first += facets.size()) {
      const std::size_t count = std::min(facets.size(), end - first);
      const std::size_t offset = kHeaderBytes + first * kFacetBytes;
      for (std::size_t i = 0; i < count; ++i) {
        const char* const facet = bytes.data() + offset + i * kFacetBytes;
        __builtin_prefetch(std::min(facet + kBytesAhead, bytes.data() + bytes.size() - 1));
        std::memcpy(&facets[i], facet + kNormalBytes, sizeof(Facet));
      }
      add(sink, std::span(facets).first(count), offset);
    }
    return sink;
  };
  const auto add_all = [](FacetSink& sink, std::span<Facet> facets, std::size_t) {
    sink.add_unchecked(facets);
  };
  const auto add_finite = [](FacetSink& sink, std::span<Facet> facets, std::size_t offset) {
    for (std::size_t i = 0; i < facets.size(); ++i)
      sink.add(facets[i], [&] { return "byte " + std::to_string(offset + i * kFacetBytes); });
  };
  const auto read = [&](std::size_t block, std::size_t begin, std::size_t end) {
    const auto keep = [&](FacetSink sink) {
      std::vector<FloatPoint> vertices = sink.take_vertices();
      parts[block] = {std::move(vertices),
                      std::span(triangles).subspan(begin, end - begin - sink.dropped())};
    };
    // Nearly all files are sound: rather read a part again than look at every corner.
    FacetSink sink = fill_sink(begin, end, add_all);
    keep(sink.all_finite() ? std::move(sink) : fill_sink(begin, end, add_finite));
  };
  for_each_block(extent.facets, context.parallel_for, read);
  raw.mesh.vertices = join_parts(parts, context.parallel_for);
  // Facets that were left out are gaps at the ends of parts.
  auto* end = triangles.data();
  for (const WeldedPart& part : parts) {
    if (part.triangles.data() != end) std::copy(part.triangles.begin(), part.triangles.end(), end);
    end += part.triangles.size();
  }
  triangles.resize(static_cast<std::size_t>(end - triangles.data()));
  warn_of_dropped(extent.facets - triangles.size(), raw.warnings);
  if (!extent.warning.empty()) raw.warnings.push_back(extent.warning);
  return raw;
}

bool is_exact_binary_stl(std::span<const char> bytes) {
  return bytes.size() >= kHeaderBytes &&
         bytes.size() == kHeaderBytes + std::size_t{count_field(bytes)} * kFacetBytes;
}

StlKind stl_kind(std::span<const char> bytes) {
  if (is_exact_binary_stl(bytes)) return StlKind::kBinary;
  // Text has no zero bytes. A binary file has some in its count, its normals or its attributes.
  constexpr std::size_t kLookAt = 4096;
  std::string_view head(bytes.data(), std::min(bytes.size(), kLookAt));
  if (head.find('\0') != std::string_view::npos) {
    return bytes.size() >= kHeaderBytes ? StlKind::kBinary : StlKind::kNeither;
  }
  if (head.starts_with("\xEF\xBB\xBF")) head.remove_prefix(3);
  const std::size_t start = head.find_first_not_of(" \t\r\n\v\f");
  if (start == std::string_view::npos) return StlKind::kNeither;
  std::string word(head.substr(start, 5));
  for (char& c : word) c = static_cast<char>(c | 0x20);  // to lower case; exact for letters
  return word == "solid" || word == "facet" ? StlKind::kAscii : StlKind::kNeither;
}

RawMesh read_stl(std::span<const char> bytes, const ReadContext& context) {
  if (bytes.empty()) refuse_model(context.name, "empty file");
  switch (stl_kind(bytes)) {
    case StlKind::kBinary:
      return read_binary_stl(bytes, context);
    case StlKind::kAscii:
      return read_ascii_stl(bytes, context);
    case StlKind::kNeither:
      break;
  }
  refuse_model(context.name,
               "not a mesh: neither a binary STL (84 bytes and 50 a facet) nor an ASCII one "
               "(begins with the word solid)");
}

}  // namespace routebench::models
