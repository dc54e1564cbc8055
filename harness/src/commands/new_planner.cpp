#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <memory>
#include <sstream>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

#include "installed_files.hpp"
#include "routebench/geometry/error.hpp"
#include "routebench/harness/commands.hpp"
#include "routebench/harness/output.hpp"
#include "routebench/harness/pipeline.hpp"

namespace routebench {
namespace {

namespace fs = std::filesystem;

struct NewPlannerArguments {
  std::string name;
  std::string folder;
  bool python = false;
};

/// One of the template's files and what it becomes.
struct TemplateFile {
  std::string from;
  std::string to;
};

/// Targets that every CMake project has or may not have.
constexpr std::array<std::string_view, 6> kTakenTargets{"all",  "clean",   "help",
                                                        "test", "install", "package"};

/// snake_case, as names of planners are, and as C++ and CMake take them.
void check_name(const std::string& name) {
  const auto is_letter = [](char c) { return c >= 'a' && c <= 'z'; };
  const auto is_inner = [&](char c) { return is_letter(c) || (c >= '0' && c <= '9') || c == '_'; };
  if (name.empty() || !is_letter(name.front()) || !std::all_of(name.begin(), name.end(), is_inner))
    throw Error(ErrorKind::kBadUsage, "'" + name +
                                          "' is no name for a planner; use small letters, digits "
                                          "and _, with a letter first, such as my_spiral");
  if (std::find(kTakenTargets.begin(), kTakenTargets.end(), name) != kTakenTargets.end())
    throw Error(ErrorKind::kBadUsage,
                "'" + name + "' means something to CMake; choose another name");
  if (load_planners({}).registry.entries().contains(name))
    throw Error(ErrorKind::kBadUsage,
                "there is a planner " + name + " already; choose another name");
}

/// my_spiral becomes MySpiralPlanner: no type of ours is called like that.
std::string class_name(const std::string& name) {
  std::string result;
  bool upper = true;
  for (const char c : name) {
    if (c != '_')
      result += upper ? static_cast<char>(c - (c >= 'a' && c <= 'z' ? 'a' - 'A' : 0)) : c;
    upper = c == '_';
  }
  return result + "Planner";
}

std::string filled_in(std::string text, const std::string& name) {
  for (const auto& [mark, value] :
       {std::pair<std::string, std::string>{"@NAME@", name}, {"@CLASS@", class_name(name)}})
    for (std::size_t at = text.find(mark); at != text.npos; at = text.find(mark, at + value.size()))
      text.replace(at, mark.size(), value);
  return text;
}

std::string content_of(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  std::ostringstream text;
  text << in.rdbuf();
  if (!in) throw Error(ErrorKind::kBadInput, file.string() + ": cannot be read");
  return text.str();
}

/// Where CMake has to look for the package; empty where it looks anyway or where there is none.
std::string package_prefix() {
  std::error_code error;
  const fs::path program = fs::read_symlink("/proc/self/exe", error);
  const fs::path prefix = program.parent_path().parent_path();
  if (prefix == "/usr" || prefix == "/usr/local") return {};
  return fs::is_directory(prefix / ROUTEBENCH_PACKAGE_FOLDER, error) ? prefix.string()
                                                                     : std::string();
}

void write_project(const NewPlannerArguments& arguments) {
  check_name(arguments.name);
  const fs::path folder = arguments.folder;
  std::error_code error;
  if (fs::exists(folder, error) && !fs::is_empty(folder, error))
    throw Error(ErrorKind::kBadInput,
                folder.string() + ": is there already and not empty; name a new folder");
  const fs::path source = data_folder("planner_template", "planners/template", "cpp/planner.cpp") /
                          (arguments.python ? "python" : "cpp");
  std::vector<TemplateFile> files{{"experiment.toml", "experiment.toml"}};
  if (arguments.python) {
    files.push_back({"planner.py", arguments.name + ".py"});
  } else {
    files.push_back({"planner.cpp", arguments.name + ".cpp"});
    files.push_back({"CMakeLists.txt", "CMakeLists.txt"});
  }
  OutputSet outputs;
  outputs.add_folder(folder);
  for (const auto& [from, to] : files)
    outputs.add(folder / to, [&, text = filled_in(content_of(source / from), arguments.name)](
                                 std::ostream& out) { out << text; });
  outputs.commit();

  std::cout << "wrote " << folder.string() << "; next, in that folder:\n";
  if (!arguments.python) {
    const std::string prefix = package_prefix();
    std::cout << "  cmake -B build" << (prefix.empty() ? "" : " -DCMAKE_PREFIX_PATH=" + prefix)
              << "\n  cmake --build build\n";
  }
  std::cout << "  routebench check-planner " << arguments.name << " --plugin "
            << (arguments.python ? arguments.name + ".py" : "build/" + arguments.name + ".so")
            << "\n"
            << "  routebench run experiment.toml --out results\n  routebench plot results\n";
}

}  // namespace

void add_new_planner_command(CLI::App& app, int& exit_code) {
  const auto arguments = std::make_shared<NewPlannerArguments>();
  CLI::App& command =
      *app.add_subcommand("new-planner", "Write a planner of your own that works at once");
  command.add_option("NAME", arguments->name, "Of the planner, in snake_case")
      ->type_name("")
      ->required();
  command.add_option("DIR", arguments->folder, "A folder that is new or empty")
      ->type_name("")
      ->required();
  command.add_flag("--python", arguments->python,
                   "One file of Python, which needs no compiler, instead of C++");
  command.callback([arguments, &exit_code] {
    write_project(*arguments);
    exit_code = 0;
  });
}

}  // namespace routebench
