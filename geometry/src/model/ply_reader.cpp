#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <string>
#include <vector>

#include "model/face_sink.hpp"
#include "model/formats.hpp"
#include "model/ply_header.hpp"
#include "model/text_lines.hpp"

namespace routebench::models {
namespace {

/// Numbers of the body in text, one word each.
class TextBody {
 public:
  TextBody(std::span<const char> bytes, const ReadContext& context, std::size_t first_line)
      : lines_(bytes, context.name, first_line) {}

  /// False at the end of the file.
  bool number(PlyType, double& value) {
    const std::string_view word = lines_.word_on_any_line();
    if (word.empty()) return false;
    value = lines_.number(word);
    return true;
  }
  [[nodiscard]] std::size_t bytes_left() const { return lines_.bytes_left(); }
  [[nodiscard]] static std::size_t least_bytes(PlyType) { return 2; }
  [[nodiscard]] std::string place() const { return lines_.place(); }

 private:
  TextLines lines_;
};

/// Numbers of the body in binary.
class BinaryBody {
 public:
  BinaryBody(std::span<const char> bytes, std::size_t offset, bool big_endian)
      : bytes_(bytes),
        at_(offset),
        swap_(big_endian != (std::endian::native == std::endian::big)) {}

  bool number(PlyType type, double& value) {
    const std::size_t size = ply_bytes(type);
    if (size > bytes_left()) return false;
    std::array<char, 8> raw{};
    std::memcpy(raw.data(), bytes_.data() + at_, size);
    if (swap_) std::reverse(raw.data(), raw.data() + size);
    at_ += size;
    value = converted(type, raw);
    return true;
  }
  [[nodiscard]] std::size_t bytes_left() const { return bytes_.size() - at_; }
  [[nodiscard]] static std::size_t least_bytes(PlyType type) { return ply_bytes(type); }
  [[nodiscard]] std::string place() const { return "byte " + std::to_string(at_); }

 private:
  template <typename T>
  static double as(const std::array<char, 8>& raw) {
    T value;
    std::memcpy(&value, raw.data(), sizeof value);
    return static_cast<double>(value);
  }
  static double converted(PlyType type, const std::array<char, 8>& raw) {
    switch (type) {
      case PlyType::kInt8:
        return as<std::int8_t>(raw);
      case PlyType::kUint8:
        return as<std::uint8_t>(raw);
      case PlyType::kInt16:
        return as<std::int16_t>(raw);
      case PlyType::kUint16:
        return as<std::uint16_t>(raw);
      case PlyType::kInt32:
        return as<std::int32_t>(raw);
      case PlyType::kUint32:
        return as<std::uint32_t>(raw);
      case PlyType::kFloat32:
        return as<float>(raw);
      case PlyType::kFloat64:
        break;
    }
    return as<double>(raw);
  }

  std::span<const char> bytes_;
  std::size_t at_;
  bool swap_;
};

/// Goes through the elements of a body.
template <typename Body>
class PlyReader {
 public:
  PlyReader(Body body, const PlyHeader& header, const ReadContext& context)
      : body_(std::move(body)), header_(header), context_(context), sink_(context) {}

  RawMesh read() {
    bool single = header_.format != PlyHeader::Format::kText;
    for (const PlyElement& element : header_.elements) {
      if (element.name == "vertex") {
        read_vertices(element);
        single &= element.properties[element.find("x")].type == PlyType::kFloat32;
      } else if (element.name == "face") {
        read_faces(element);
        break;  // nothing behind the faces says where the surface is
      } else {
        skip(element);
      }
    }
    RawMesh raw = sink_.finish(single);
    if (!cut_.empty()) raw.warnings.push_back(cut_);
    return raw;
  }

 private:
  [[noreturn]] void refuse(const std::string& complaint) const {
    refuse_model(context_.name, complaint);
  }

  [[nodiscard]] std::string end_inside(const PlyElement& element, std::size_t i) const {
    return "cut short: the file ends inside " + element.name + ' ' + std::to_string(i) + " of " +
           std::to_string(element.count) + " (counted from 0)";
  }
  [[noreturn]] void refuse_end(const PlyElement& element, std::size_t i) const {
    refuse(end_inside(element, i));
  }

  /// Elements that the rest of the file can hold, looked at before anything is allocated.
  [[nodiscard]] std::size_t bounded_count(const PlyElement& element) const {
    std::size_t least = 0;
    for (const PlyProperty& p : element.properties) {
      least += body_.least_bytes(p.is_list ? p.count_type : p.type);
    }
    if (element.count == 0) return 0;
    if (least == 0) refuse("element " + in_quotes(element.name) + " has no properties");
    const std::size_t room = body_.bytes_left() / least + 1;  // the last blank may be missing
    if (element.count > room && !context_.repair) {
      refuse("cut short: the header announces " + std::to_string(element.count) + ' ' +
             element.name + " elements, for which the file is too short");
    }
    return std::min(element.count, room);
  }

  /// Reads one element: single numbers into values_, the list wanted into list_. False at the end.
  bool read_element(const PlyElement& element,
                    std::size_t wanted_list = std::numeric_limits<std::size_t>::max()) {
    values_.assign(element.properties.size(), 0);
    for (std::size_t p = 0; p < element.properties.size(); ++p) {
      const PlyProperty& property = element.properties[p];
      if (!property.is_list) {
        if (!body_.number(property.type, values_[p])) return false;
        continue;
      }
      double length = 0;
      if (!body_.number(property.count_type, length)) return false;
      if (!(length >= 0) || length != std::floor(length)) {
        refuse(body_.place() + ": a list of " + rounded(length) + " entries cannot be meant");
      }
      if (p == wanted_list) list_.clear();
      for (double i = 0; i < length; ++i) {
        double entry = 0;
        if (!body_.number(property.type, entry)) return false;
        if (p == wanted_list) list_.push_back(entry);
      }
    }
    return true;
  }

  void skip(const PlyElement& element) {
    static_cast<void>(bounded_count(element));
    for (std::size_t i = 0; i < element.count; ++i) {
      if (!read_element(element)) refuse_end(element, i);
    }
  }

  void read_vertices(const PlyElement& element) {
    std::array<std::size_t, 3> axes{};
    for (std::size_t a = 0; a < 3; ++a) {
      const std::string name(1, "xyz"[a]);
      axes[a] = element.find(name);
      if (axes[a] == element.properties.size() || element.properties[axes[a]].is_list) {
        refuse("vertices without a property " + name);
      }
    }
    sink_.reserve(bounded_count(element), 0);
    for (std::size_t i = 0; i < element.count; ++i) {
      if (!read_element(element)) refuse_end(element, i);
      sink_.add_vertex({values_[axes[0]], values_[axes[1]], values_[axes[2]]});
    }
  }

  void read_faces(const PlyElement& element) {
    std::size_t list = element.find("vertex_indices");
    if (list == element.properties.size()) list = element.find("vertex_index");
    if (list == element.properties.size() || !element.properties[list].is_list) {
      refuse("faces without a list of vertex_indices");
    }
    sink_.reserve(0, bounded_count(element));
    for (std::size_t i = 0; i < element.count; ++i) {
      if (!read_element(element, list)) {
        cut_ = end_inside(element, i);
        if (!context_.repair) refuse(cut_ + "; with --repair the whole faces are read");
        return;
      }
      corners_.clear();
      for (const double corner : list_) {
        if (!(std::abs(corner) < 1e15) || corner != std::floor(corner)) {
          refuse(body_.place() + ": " + rounded(corner) + " is no number of a vertex");
        }
        corners_.push_back(static_cast<std::int64_t>(corner));
      }
      sink_.add_face(corners_, [this] { return body_.place(); });
    }
  }

  Body body_;
  const PlyHeader& header_;
  const ReadContext& context_;
  FaceSink sink_;
  std::vector<double> values_;
  std::vector<double> list_;
  std::vector<std::int64_t> corners_;
  std::string cut_;
};

}  // namespace

RawMesh read_ply(std::span<const char> bytes, const ReadContext& context) {
  const PlyHeader header = read_ply_header(bytes, context);
  if (header.format == PlyHeader::Format::kText) {
    TextBody body(bytes.subspan(header.body_offset), context, header.body_line);
    return PlyReader<TextBody>(std::move(body), header, context).read();
  }
  const bool big = header.format == PlyHeader::Format::kBigEndian;
  return PlyReader<BinaryBody>(BinaryBody(bytes, header.body_offset, big), header, context).read();
}

}  // namespace routebench::models
