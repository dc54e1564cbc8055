#include "routebench/harness/provenance.hpp"

#include <elf.h>
#include <link.h>
#include <sched.h>
#include <sqlite3.h>
#include <sys/utsname.h>
#include <toml++/toml.h>
#include <unistd.h>

#include <CLI/Version.hpp>
#include <array>
#include <cstring>
#include <ctime>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>

#include "routebench/harness/build_commit.hpp"
#include "routebench/harness/version.hpp"

namespace routebench {
namespace {

std::string joined(std::initializer_list<int> numbers) {
  std::string text;
  for (const int number : numbers) text += (text.empty() ? "" : ".") + std::to_string(number);
  return text;
}

/// The build id in a loaded object's notes; see the ELF specification, note sections.
std::string build_id_of(const dl_phdr_info& object) {
  constexpr std::string_view kDigits = "0123456789abcdef";
  for (int i = 0; i < object.dlpi_phnum; ++i) {
    const ElfW(Phdr)& segment = object.dlpi_phdr[i];
    if (segment.p_type != PT_NOTE) continue;
    // Addresses come as numbers here.
    const char* at = reinterpret_cast<const char*>(object.dlpi_addr + segment.p_vaddr);
    const char* const end = at + segment.p_memsz;
    while (end - at >= static_cast<std::ptrdiff_t>(sizeof(ElfW(Nhdr)))) {
      ElfW(Nhdr) note{};
      std::memcpy(&note, at, sizeof note);
      const auto padded = [](std::size_t size) { return (size + 3) / 4 * 4; };
      const std::string_view name(at + sizeof note, note.n_namesz);
      const std::string_view content(name.data() + padded(note.n_namesz), note.n_descsz);
      if (note.n_type == NT_GNU_BUILD_ID && name == std::string_view("GNU", 4)) {
        std::string id;
        for (const char c : content) {
          const auto byte = static_cast<unsigned char>(c);
          id += {kDigits[byte / 16u], kDigits[byte % 16u]};
        }
        return id;
      }
      at = content.data() + padded(note.n_descsz);
    }
  }
  return {};
}

/// The build ids of the program and of our own shared libraries, but for those that are loaded only
/// once a 3MF file or a skeleton is asked for: what was done before must not matter.
std::string program_build_id() {
  std::string ids;
  const auto visit = [](dl_phdr_info* object, std::size_t, void* list) {
    const std::string_view name = object->dlpi_name;  // the program itself has none
    const auto is_of = [name](std::string_view part) { return name.find(part) != name.npos; };
    if (name.empty() || (is_of("libroutebench_") && !is_of("_3mf.so") && !is_of("_skeleton.so")))
      static_cast<std::string*>(list)->append(build_id_of(*object));
    return 0;
  };
  dl_iterate_phdr(visit, &ids);
  return ids;
}

std::string libraries_json() {
  nlohmann::json libraries{
      {"SQLite", sqlite3_libversion()},
      {"CLI11", CLI11_VERSION},
      {"toml++", joined({TOML_LIB_MAJOR, TOML_LIB_MINOR, TOML_LIB_PATCH})},
      {"nlohmann-json", joined({NLOHMANN_JSON_VERSION_MAJOR, NLOHMANN_JSON_VERSION_MINOR,
                                NLOHMANN_JSON_VERSION_PATCH})},
      {"CGAL", kCgalVersion},
      {"Boost", kBoostVersion},
      {"Clipper", kClipperVersion}};
  return libraries.dump();
}

/// The rest of the first line of a file that begins with a key, without separators and quotes.
std::string value_in_file(const char* file, std::string_view key) {
  std::ifstream in(file);
  for (std::string line; std::getline(in, line);) {
    if (!line.starts_with(key)) continue;
    const std::size_t begin = line.find_first_not_of(" \t:=\"", key.size());
    const std::size_t end = line.find_last_not_of(" \t\"");
    if (begin != std::string::npos) return line.substr(begin, end - begin + 1);
  }
  return "unknown";
}

std::string operating_system() {
  utsname kernel{};
  const std::string release = uname(&kernel) == 0 ? kernel.release : "unknown";
  return value_in_file("/etc/os-release", "PRETTY_NAME") + ", kernel " + release;
}

int usable_cores() {
  cpu_set_t set;
  CPU_ZERO(&set);
  if (sched_getaffinity(0, sizeof set, &set) == 0) return CPU_COUNT(&set);
  return static_cast<int>(sysconf(_SC_NPROCESSORS_ONLN));
}

std::string shell_quoted(const std::string& word) {
  constexpr std::string_view kPlain =
      "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789-_./=:,+@%";
  if (!word.empty() && word.find_first_not_of(kPlain) == std::string::npos) return word;
  std::string quoted = "'";
  for (const char c : word) quoted += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return quoted + "'";
}

}  // namespace

Provenance collect_provenance() {
  Provenance here;
  here.routebench_version = kVersion;
  if (!kGitCommit.empty()) {
    here.git_commit = kGitCommit;
    here.git_dirty = kGitDirty;
  }
  here.compiler = kCompiler;
  here.compiler_flags = kCompilerFlags;
  here.program_build_id = program_build_id();
  here.libraries_json = libraries_json();
  here.cpu = value_in_file("/proc/cpuinfo", "model name");
  here.cores = usable_cores();
  here.memory_bytes = static_cast<std::int64_t>(sysconf(_SC_PHYS_PAGES)) * sysconf(_SC_PAGESIZE);
  here.os = operating_system();
  return here;
}

std::string command_line() {
  std::ifstream in("/proc/self/cmdline", std::ios::binary);
  std::string line;
  for (std::string word; std::getline(in, word, '\0');)
    line += (line.empty() ? "" : " ") + shell_quoted(word);
  return line;
}

std::string utc_now() {
  const std::time_t now = std::time(nullptr);
  std::tm parts{};
  gmtime_r(&now, &parts);
  std::array<char, 32> text{};
  const std::size_t length = std::strftime(text.data(), text.size(), "%Y-%m-%dT%H:%M:%SZ", &parts);
  return {text.data(), length};
}

}  // namespace routebench
