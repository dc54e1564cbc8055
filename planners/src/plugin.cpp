#include "routebench/planning/plugin.hpp"

#include <cxxabi.h>
#include <dlfcn.h>

#include <cstdlib>
#include <exception>
#include <memory>
#include <optional>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

#include "routebench/geometry/error.hpp"
#include "routebench/planning/sha256.hpp"

namespace routebench {
namespace {

/// Why a plugin is not taken. Never leaves this file.
struct Refusal {
  std::string reason;
};

constexpr const char* kEntryPoint = "routebench_plugin";
using DescribePlugin = PluginDescription (*)();

std::string linker_complaint() {
  const char* complaint = dlerror();
  return complaint != nullptr ? complaint : "no reason given";
}

void check_built_for_this_program(const PluginDescription& plugin) {
  if (plugin.abi != kPluginAbi) {
    throw Refusal{"plugin ABI " + std::to_string(plugin.abi) + ", but this program has " +
                  std::to_string(kPluginAbi) + ": build it again with this version's headers"};
  }
  const std::string_view theirs = plugin.build_id != nullptr ? plugin.build_id : "";
  const std::string_view ours = plugin_build_id();
  if (theirs != ours) {
    throw Refusal{"built with '" + std::string(theirs) + "', but this program with '" +
                  std::string(ours) + "': C++ types cross the border, so these must agree"};
  }
  if (plugin.register_planners == nullptr) throw Refusal{"its description has no function to call"};
}

/// Writes C++ names as people do.
std::string demangled(const std::string& symbol) {
  int status = 0;
  const std::unique_ptr<char, decltype(&std::free)> text(
      abi::__cxa_demangle(symbol.c_str(), nullptr, nullptr, &status), &std::free);
  return status == 0 ? text.get() : symbol;
}

/// What a library lacks that the linker could not open; nothing if that was not why.
std::optional<std::string> missing_symbol(const std::string& complaint) {
  constexpr std::string_view kMark = "undefined symbol: ";
  const std::size_t mark = complaint.find(kMark);
  if (mark == std::string::npos) return std::nullopt;
  const std::size_t begin = mark + kMark.size();
  return demangled(complaint.substr(begin, complaint.find_first_of(" ,\t\n", begin) - begin));
}

/// The plugin's entry point. The library is never closed, not even if it is refused later: objects
/// of its making (an exception, say) may still be about.
DescribePlugin open_library(const std::filesystem::path& file) {
  // With a slash in its name the file itself is opened, and no folder is searched for it.
  void* library = dlopen(std::filesystem::absolute(file).c_str(), RTLD_NOW | RTLD_LOCAL);
  if (library == nullptr) {
    const std::string complaint = linker_complaint();
    const std::optional<std::string> missing = missing_symbol(complaint);
    if (!missing) throw Refusal{"not a shared library of this system: " + complaint};
    // Of another build? If its functions need not be there, it can be asked.
    void* incomplete = dlopen(std::filesystem::absolute(file).c_str(), RTLD_LAZY | RTLD_LOCAL);
    void* entry = incomplete != nullptr ? dlsym(incomplete, kEntryPoint) : nullptr;
    if (entry != nullptr) check_built_for_this_program(reinterpret_cast<DescribePlugin>(entry)());
    throw Refusal{"nothing defines " + *missing + ", which it uses"};
  }
  void* symbol = dlsym(library, kEntryPoint);
  if (symbol == nullptr) {
    throw Refusal{std::string("no routebench plugin: it lacks the symbol ") + kEntryPoint +
                  " that ROUTEBENCH_REGISTER defines"};
  }
  return reinterpret_cast<DescribePlugin>(symbol);
}

std::vector<std::string> names_only_in(const Registry& now, const Registry& before) {
  std::vector<std::string> names;
  for (const auto& [name, entry] : now.entries()) {
    if (!before.entries().contains(name)) names.push_back(name);
  }
  return names;
}

/// Registers into a copy, so that a plugin that fails half-way leaves nothing behind.
std::vector<std::string> register_all(Registry& registry, const PluginDescription& plugin,
                                      const std::string& file) {
  Registry trial = registry;
  trial.set_origin(file);
  try {
    plugin.register_planners(trial);
  } catch (const std::exception& failure) {
    throw Refusal{std::string("registering failed: ") + failure.what()};
  } catch (...) {
    throw Refusal{"registering failed with an exception that is no std::exception"};
  }
  std::vector<std::string> names = names_only_in(trial, registry);
  if (names.empty()) throw Refusal{"it registers no planner"};
  trial.set_origin(registry.origin());
  registry = std::move(trial);
  return names;
}

}  // namespace

PluginRecord load_plugin(Registry& registry, const std::filesystem::path& file) {
  PluginRecord record;
  record.file = file.string();
  try {
    std::error_code unreadable;
    // Opening a named pipe would wait for ever, so look before reading.
    if (!std::filesystem::is_regular_file(file, unreadable)) {
      throw Refusal{std::filesystem::exists(file, unreadable) ? "not a regular file"
                                                              : "no such file"};
    }
    const std::optional<std::string> fingerprint = sha256_of_file(file);
    if (!fingerprint) throw Refusal{"the file cannot be read"};
    record.sha256 = *fingerprint;
    const PluginDescription plugin = open_library(file)();
    if (plugin.abi == kPluginAbi && plugin.build_id != nullptr) record.build_id = plugin.build_id;
    check_built_for_this_program(plugin);
    record.planners = register_all(registry, plugin, record.file);
    record.loaded = true;
  } catch (const Refusal& refusal) {
    record.refused_because = one_line(refusal.reason);
  } catch (const std::exception& failure) {
    record.refused_because = one_line(failure.what());
  }
  return record;
}

}  // namespace routebench
