#include "slicers/command.hpp"

#include <algorithm>
#include <functional>
#include <map>
#include <set>

#include "routebench/geometry/error.hpp"
#include "routebench/geometry/nearest_name.hpp"

namespace routebench::slicers {
namespace {

[[noreturn]] void refuse(const std::string& complaint) {
  throw Error(ErrorKind::kBadInput, complaint);
}

/// Splits at blanks outside quotes.
std::vector<std::string> split(const std::string& command) {
  std::vector<std::string> words;
  bool in_word = false;
  char quote = 0;
  for (const char c : command) {
    if (static_cast<unsigned char>(c) < ' ' && c != '\t')
      refuse("the command has a control character; write it on one line");
    if (quote == 0 && (c == ' ' || c == '\t')) {
      in_word = false;
      continue;
    }
    if (!in_word) words.emplace_back();
    in_word = true;
    if (quote == 0 && (c == '\'' || c == '"'))
      quote = c;
    else if (c == quote)
      quote = 0;
    else
      words.back() += c;
  }
  if (quote != 0) refuse(std::string("the command has a quote ") + quote + " that is not closed");
  return words;
}

/// A word with `value_of(name)` in the place of each `{name}`.
std::string replaced(const std::string& word,
                     const std::function<std::string(const std::string&)>& value_of) {
  std::string result;
  for (std::size_t i = 0; i < word.size(); ++i) {
    const char c = word[i];
    const bool doubled = i + 1 < word.size() && word[i + 1] == c;
    if (c != '{' && c != '}') {
      result += c;
    } else if (doubled) {
      result += c;
      ++i;
    } else {
      const std::size_t end = word.find('}', i);
      if (c == '}' || end == word.npos)
        refuse("the command has a brace without its partner; write {{ or }} for a brace");
      result += value_of(word.substr(i + 1, end - i - 1));
      i = end;
    }
  }
  return result;
}

/// What placeholders stand for.
std::map<std::string, std::string> values_of(const SliceJob& job) {
  std::map<std::string, std::string> values{
      {"model", job.model}, {"gcode", job.gcode}, {"folder", job.folder}};
  for (const KeyValue& pair : task_values(job.task)) values["task." + pair.key] = pair.value;
  for (const KeyValue& pair : printer_values(job.printer))
    values["printer." + pair.key] = pair.value;
  return values;
}

}  // namespace

std::vector<std::string> command_words(const std::string& command) {
  std::vector<std::string> words = split(command);
  if (words.empty()) refuse("the command is empty");
  std::vector<std::string> known;
  for (const auto& [name, value] : values_of({Task{}, Printer{}, {}, {}, {}}))
    known.push_back(name);
  std::set<std::string> seen;
  const auto check = [&](const std::string& name) {
    if (std::find(known.begin(), known.end(), name) == known.end()) {
      const std::optional<std::string> near = nearest_name(name, known);
      refuse("the command has the unknown placeholder {" + name + "}" +
             (near ? "; did you mean {" + *near + "}?"
                   : "; known are {model}, {gcode}, {folder}, {task.KEY} and {printer.KEY}"));
    }
    seen.insert(name);
    return std::string();
  };
  if (words.front().find_first_of("{}") != std::string::npos)
    refuse("the command begins with " + words.front() + "; its first word must be a program");
  for (const std::string& word : words) replaced(word, check);
  for (const char* wanted : {"model", "gcode"})
    if (!seen.contains(wanted))
      refuse("the command lacks {" + std::string(wanted) +
             "}; write something like \"slicer --output {gcode} {model}\"");
  return words;
}

std::vector<std::string> filled_words(const std::vector<std::string>& words, const SliceJob& job) {
  const std::map<std::string, std::string> values = values_of(job);
  std::vector<std::string> filled;
  for (const std::string& word : words)
    filled.push_back(replaced(word, [&](const std::string& name) { return values.at(name); }));
  return filled;
}

}  // namespace routebench::slicers
