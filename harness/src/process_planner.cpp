#include "process_planner.hpp"

#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <mutex>
#include <optional>
#include <utility>
#include <vector>

#include "byte_stream.hpp"
#include "installed_files.hpp"
#include "planner_protocol.hpp"
#include "python_program.hpp"
#include "routebench/geometry/error.hpp"
#include "routebench/planning/sha256.hpp"

namespace routebench {

namespace fs = std::filesystem;

namespace {

/// Python with all that a planner may import takes its time to begin.
constexpr double kSilenceS = 60;

bool is_space(char c) { return c == ' ' || c == '\t' || c == '\n' || c == '\r'; }

/// Splits at white space; ' and " keep what is between them together.
std::vector<std::string> words_of(const std::string& text) {
  std::vector<std::string> words;
  bool in_word = false;
  char quote = 0;
  for (const char c : text) {
    if (quote == 0 && is_space(c)) {
      in_word = false;
      continue;
    }
    if (!in_word) words.emplace_back();
    in_word = true;
    if (c == quote)
      quote = 0;
    else if (quote == 0 && (c == '"' || c == '\''))
      quote = c;
    else
      words.back() += c;
  }
  const std::string command = std::string(kCommandPrefix) + text;
  if (quote != 0) throw Error(ErrorKind::kBadInput, command + ": a quote is not closed");
  if (words.empty() || words.front().empty())
    throw Error(ErrorKind::kBadInput, command + ": there is no word in it that names a program");
  return words;
}

/// Reads an answer; what is wrong with it is told with its place and the last words beside it.
template <typename Read>
auto understood(PlannerProcess& process, Read&& read) {
  try {
    return read();
  } catch (const PlannerComplaint&) {
    throw;
  } catch (const Error& error) {
    throw Error(ErrorKind::kBadInput, "line " + std::to_string(process.lines()) +
                                          " of its output: " + error.what() + process.last_words());
  }
}

}  // namespace

class PlannerProcesses {
 public:
  /// Takes  whether times that an answer gives are to be believed.
  PlannerProcesses(PlannerCommand command, bool gives_times)
      : command_(std::move(command)), gives_times_(gives_times) {}

  /// Starts a process just to hear what it says of itself.
  [[nodiscard]] ProgramDescription describe() const {
    // A refusal is one line, which has the last words.
    PlannerProcess process(command_, PlannerProcess::Errors::kKeep);
    return greeted(process);
  }

  [[nodiscard]] Route plan(const std::string& planner, const ParamSet& params, const Layer& layer,
                           const PlanContext& context, PlanTime& times) {
    stop_if_asked(context);
    std::unique_ptr<PlannerProcess> process = take();
    const std::string request = plan_request(planner, params, layer, context);
    const PlannerProcess::Answer answer = process->ask(request, context.stop);
    PlanAnswer read = understood(*process, [&] { return read_route(answer.line, context); });
    give_back(std::move(process));
    const PlanTime seen{answer.wall_ns, answer.cpu_ns};
    const PlanTime taken = gives_times_ ? read.times.value_or(seen) : seen;
    times.wall_ns += taken.wall_ns;
    times.cpu_ns += taken.cpu_ns;
    return std::move(read.route);
  }

  [[nodiscard]] std::uint64_t peak_rss_bytes() {
    const std::lock_guard lock(mutex_);
    forget_others();
    std::uint64_t peak = 0;
    for (const auto& process : idle_) peak = std::max(peak, process->peak_rss_bytes());
    return peak;
  }

 private:
  static ProgramDescription greeted(PlannerProcess& process) {
    const PlannerProcess::Answer answer = process.ask(describe_request(), {}, kSilenceS);
    return understood(process, [&] { return read_description(answer.line); });
  }

  std::unique_ptr<PlannerProcess> take() {
    {
      const std::lock_guard lock(mutex_);
      forget_others();
      if (!idle_.empty()) {
        std::unique_ptr<PlannerProcess> process = std::move(idle_.back());
        idle_.pop_back();
        return process;
      }
    }
    auto process = std::make_unique<PlannerProcess>(command_);
    static_cast<void>(greeted(*process));  // so that its start is over when time is taken
    return process;
  }

  void give_back(std::unique_ptr<PlannerProcess> process) {
    const std::lock_guard lock(mutex_);
    idle_.push_back(std::move(process));
  }

  /// Processes that another process started, from which this one was forked, are not ours.
  void forget_others() {
    if (std::exchange(owner_, getpid()) != getpid()) idle_.clear();
  }

  PlannerCommand command_;
  bool gives_times_;
  std::mutex mutex_;
  pid_t owner_ = getpid();
  std::vector<std::unique_ptr<PlannerProcess>> idle_;
};

ProcessPlanner::ProcessPlanner(std::shared_ptr<PlannerProcesses> processes, std::string name,
                               ParamSet params)
    : processes_(std::move(processes)), name_(std::move(name)), params_(std::move(params)) {}

Route ProcessPlanner::plan(const Layer& layer, const PlanContext& context) const {
  PlanTime times;
  return plan(layer, context, times);
}

Route ProcessPlanner::plan(const Layer& layer, const PlanContext& context, PlanTime& times) const {
  return processes_->plan(name_, params_, layer, context, times);
}

std::uint64_t ProcessPlanner::peak_rss_bytes() const { return processes_->peak_rss_bytes(); }

namespace {

Registry::Entry entry_of(const PlannerDescription& planner, const std::string& known_as,
                         const std::string& origin,
                         const std::shared_ptr<PlannerProcesses>& processes) {
  Registry::Entry entry;
  entry.info = planner.info;
  entry.info.name = known_as;
  entry.params = planner.params;
  entry.origin = origin;
  entry.resolve = [owner = "planner " + known_as, schema = planner.params](const ParamSet& values) {
    return resolved_params(owner, schema, values);
  };
  entry.make = [resolve = entry.resolve, processes,
                name = planner.info.name](const ParamSet& values) {
    return std::make_unique<const ProcessPlanner>(processes, name, resolve(values));
  };
  return entry;
}

/// Registers all that a program describes, or nothing.
void register_program(Registry& registry, const std::shared_ptr<PlannerProcesses>& processes,
                      const std::string& command_name, PluginRecord& record) {
  const ProgramDescription program = processes->describe();
  if (!command_name.empty() && program.planners.size() != 1)
    throw Error(ErrorKind::kBadInput, "it describes " + std::to_string(program.planners.size()) +
                                          " planners; a command must be one");
  Registry trial = registry;
  for (const PlannerDescription& planner : program.planners) {
    const std::string& name = command_name.empty() ? planner.info.name : command_name;
    trial.add_entry(entry_of(planner, name, record.file, processes));
    record.planners.push_back(name);
  }
  registry = std::move(trial);
  record.build_id = program.made_with;
  record.loaded = true;
}

/// Does the loading and notes what becomes of it.
template <typename Load>
PluginRecord recorded(const std::string& file, Load&& load) {
  PluginRecord record;
  record.file = file;
  try {
    load(record);
  } catch (const std::exception& failure) {
    record.planners.clear();
    record.refused_because = one_line(failure.what());
  }
  return record;
}

/// Of the words and of all files that they name.
std::string fingerprint_of(const PlannerCommand& command) {
  ByteWriter all;
  for (const std::string& word : command.words) {
    all.add(std::string_view(word));
    const fs::path file = command.folder / word;
    std::error_code error;
    if (fs::is_regular_file(file, error))
      all.add(std::string_view(sha256_of_file(file).value_or("")));
  }
  return sha256(all.bytes());
}

}  // namespace

bool is_python_plugin(const std::string& file) { return fs::path(file).extension() == ".py"; }

PluginRecord load_python_plugin(Registry& registry, const std::string& file) {
  return recorded(file, [&](PluginRecord& record) {
    std::error_code error;
    if (!fs::is_regular_file(file, error))
      throw Error(ErrorKind::kBadInput,
                  fs::exists(file, error) ? "not a regular file" : "no such file");
    const std::optional<std::string> fingerprint = sha256_of_file(file);
    if (!fingerprint) throw Error(ErrorKind::kBadInput, "the file cannot be read");
    record.sha256 = *fingerprint;
    const fs::path host = python_package_folder() / "host.py";
    const PlannerCommand command{{kPython, "-B", host.string(), fs::absolute(file).string()}, {}};
    register_program(registry, std::make_shared<PlannerProcesses>(command, true), {}, record);
  });
}

bool is_command(const std::string& planner) { return planner.starts_with(kCommandPrefix); }

PluginRecord load_command(Registry& registry, const std::string& planner, const fs::path& folder) {
  const PlannerCommand command{words_of(planner.substr(kCommandPrefix.size())), folder};
  return recorded(planner, [&](PluginRecord& record) {
    record.sha256 = fingerprint_of(command);
    register_program(registry, std::make_shared<PlannerProcesses>(command, false), planner, record);
  });
}

}  // namespace routebench
