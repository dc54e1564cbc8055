#include "model/zip_archive.hpp"

#include <zip.h>

#include <array>
#include <cstdint>

namespace routebench::models {
namespace {

constexpr std::size_t kLargestFile = std::size_t{2} << 30U;

struct CloseFile {
  void operator()(zip_file_t* file) const { zip_fclose(file); }
};

}  // namespace

struct ZipArchive::Handle {
  explicit Handle(zip_t* opened) : zip(opened) {}
  ~Handle() { zip_discard(zip); }
  Handle(const Handle&) = delete;
  Handle& operator=(const Handle&) = delete;
  zip_t* zip;
};

ZipArchive::ZipArchive(std::span<const char> bytes, const std::string& name) : name_(name) {
  zip_error_t error;
  zip_error_init(&error);
  zip_source_t* const source = zip_source_buffer_create(bytes.data(), bytes.size(), 0, &error);
  zip_t* const zip = source == nullptr
                         ? nullptr
                         : zip_open_from_source(source, ZIP_RDONLY | ZIP_CHECKCONS, &error);
  if (zip == nullptr) {
    const std::string reason = zip_error_strerror(&error);
    zip_source_free(source);
    zip_error_fini(&error);
    refuse_model(name, "a damaged zip archive: " + reason);
  }
  handle_ = std::make_unique<Handle>(zip);
}

ZipArchive::~ZipArchive() = default;

std::vector<std::string> ZipArchive::names() const {
  std::vector<std::string> names;
  const zip_int64_t count = zip_get_num_entries(handle_->zip, 0);
  for (zip_int64_t i = 0; i < count; ++i) {
    const char* const name = zip_get_name(handle_->zip, static_cast<zip_uint64_t>(i), 0);
    if (name != nullptr) names.emplace_back(name);
  }
  return names;
}

std::optional<std::string> ZipArchive::read(const std::string& file) const {
  const zip_int64_t index = zip_name_locate(handle_->zip, file.c_str(), ZIP_FL_NOCASE);
  if (index < 0) return std::nullopt;
  const std::unique_ptr<zip_file_t, CloseFile> opened(
      zip_fopen_index(handle_->zip, static_cast<zip_uint64_t>(index), 0));
  if (!opened) {
    refuse_model(name_, file + " in the archive cannot be read: " + zip_strerror(handle_->zip));
  }
  std::string content;
  std::vector<char> chunk(std::size_t{1} << 16U);
  while (true) {
    const zip_int64_t read = zip_fread(opened.get(), chunk.data(), chunk.size());
    if (read == 0) return content;
    if (read < 0) {
      refuse_model(name_, file + " in the archive is damaged: " + zip_file_strerror(opened.get()));
    }
    content.append(chunk.data(), static_cast<std::size_t>(read));
    if (content.size() > kLargestFile) {
      refuse_model(name_, file + " in the archive is larger than 2 GB");
    }
  }
}

}  // namespace routebench::models
