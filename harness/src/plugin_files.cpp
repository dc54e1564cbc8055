#include "plugin_files.hpp"

#include <algorithm>
#include <cstdlib>
#include <sstream>
#include <system_error>
#include <utility>

#include "installed_files.hpp"
#include "routebench/geometry/error.hpp"
#include "routebench/planning/plugin.hpp"
#include "run_child.hpp"

namespace routebench {
namespace {

namespace fs = std::filesystem;

constexpr int kMemoryMb = 2048;

/// The value of an environment variable; empty if it is not set.
std::string environment(const char* name) {
  const char* value = std::getenv(name);
  return value != nullptr ? value : "";
}

std::string words_of(const ChildEnd& end) {
  std::string words = end.last_words.substr(0, end.last_words.find_last_not_of('\n') + 1);
  words.erase(0, words.find_last_of('\n') + 1);
  return words.empty() ? "" : ": " + words;
}

}  // namespace

std::vector<fs::path> plugin_folders() {
  std::vector<fs::path> folders;
  std::istringstream named(environment("ROUTEBENCH_PLUGIN_PATH"));
  for (std::string folder; std::getline(named, folder, ':');)
    if (!folder.empty()) folders.emplace_back(folder);
  const fs::path data = environment("XDG_DATA_HOME"), home = environment("HOME");
  if (data.is_absolute())
    folders.push_back(data / "routebench" / "plugins");
  else if (home.is_absolute())
    folders.push_back(home / ".local" / "share" / "routebench" / "plugins");
  folders.push_back(installed_plugin_folder());
  return folders;
}

std::vector<fs::path> plugin_files_in(const fs::path& folder) {
  std::vector<fs::path> files;
  std::error_code error;
  for (fs::directory_iterator entry(folder, error), end; !error && entry != end;
       entry.increment(error))
    if (entry->path().extension() == ".so" || entry->path().extension() == ".py")
      files.push_back(entry->path());
  std::sort(files.begin(), files.end());
  return files;
}

std::string trouble_of_plugin(const Registry& registry, const fs::path& file, double timeout_s) {
  ChildPool pool({.timeout_s = timeout_s, .memory_mb = kMemoryMb});
  pool.start(0, [&](ChildProgress&) {
    Registry trial = registry;
    return load_plugin(trial, file).refused_because;
  });
  std::vector<ChildPool::Finished> finished;
  while (finished.empty()) finished = pool.wait();
  ChildEnd& end = finished.front().end;
  switch (end.how) {
    case ChildEnd::How::kResult:
      return std::move(end.text);
    case ChildEnd::How::kException:
    case ChildEnd::How::kPlannerDied:
      return "throws while it is loaded: " + end.text;
    case ChildEnd::How::kExited:
      return "ends the program while it is loaded, with exit code " + std::to_string(end.code) +
             words_of(end);
    case ChildEnd::How::kSignal:
      return "crashes while it is loaded (" + signal_name(end.code) + ")" + words_of(end);
    case ChildEnd::How::kTimedOut:
      return "is not loaded after " + to_string(ParamValue(timeout_s)) + " s";
    case ChildEnd::How::kOutOfMemory:
      return "wants more than " + std::to_string(kMemoryMb) + " MB while it is loaded";
  }
  throw Error(ErrorKind::kInternal, "a child process ended in no known way");
}

}  // namespace routebench
