#pragma once
/// Experiment configs: what is written in a TOML file, checked and spread over its sweep axes.

#include <cstdint>
#include <filesystem>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "routebench/harness/contender.hpp"
#include "routebench/harness/task.hpp"
#include "routebench/planning/registry.hpp"

namespace routebench {

/// Which layers' routes are stored for pictures.
struct KeepLayers {
  enum class Rule { kNone, kMiddle, kAll, kListed };
  Rule rule = Rule::kMiddle;
  std::vector<std::size_t> listed;  ///< ascending, each once; only with kListed

  /// Places in a model of that many layers; listed places that it lacks are left out.
  [[nodiscard]] std::vector<std::size_t> of(std::size_t layer_count) const;
};

/// The [run] table: how cells are executed. Nothing here changes a score.
struct RunOptions {
  int repetitions = 5;     ///< timing samples a cell
  double timeout_s = 120;  ///< wall time of one execution of a cell
  int memory_mb = 4096;    ///< what one execution may take, above what is shared by all
  int jobs = 0;            ///< cells at a time; 0: one a core
  KeepLayers keep_layers;
};

/// One of the models of an experiment.
struct ConfiguredModel {
  std::string spec;    ///< as written
  std::string source;  ///< for slice_model: a relative path is made relative to the config's folder
  bool optional = false;  ///< left out, with a note, where it cannot be had
};

/// One point of the sweep over [task] and [printer].
struct Setting {
  std::string label;  ///< the task's name, if it has one, and the swept keys:
                      ///< "walls, retract_over_mm=1"; empty without either
  Task task;
  Printer printer;
};

/// One point of the sweep over a [[contender]].
struct ConfiguredContender {
  ContenderSpec spec;     ///< its name tells the point of the sweep: "lines [fill.angle_deg=45]"
  std::string base_name;  ///< as written
  std::string place;      ///< "FILE:LINE" of the [[contender]], for messages
  std::map<std::string, std::string> key_places;  ///< of "fill.angle_deg" and the like
};

/// What somebody says of how a contender's time grows: time ~ size^exponent, other sizes fixed.
struct Claim {
  std::string contender;  ///< name as written
  std::string size;       ///< one of claim_sizes()
  double exponent = 1;
  std::string source;
};

/// What is called a cell's size in claims: "triangles", "layers", "outline_vertices" (of all
/// layers), "side_mm" (the largest), "extrude_mm".
[[nodiscard]] std::span<const std::string_view> claim_sizes();

/// A figure from a publication, to stand beside ours.
struct PublishedFigure {
  std::string model;    ///< the spec of one of the experiment's models that resembles theirs
  std::string program;  ///< whose figure it is
  std::string metric;   ///< of ours, that says the same
  double value = 0;
  std::string note;  ///< what was different, if anything
  std::string source;
};

/// A config that was read and spread over its axes.
struct ExperimentConfig {
  std::filesystem::path file;
  std::string text;  ///< verbatim
  std::string name;
  std::vector<std::uint64_t> seeds;
  std::vector<ConfiguredModel> models;
  std::vector<std::string> plugins;  ///< files; relative ones are relative to the config's folder
  std::vector<Setting> settings;     ///< at least one
  RunOptions run;
  std::vector<ConfiguredContender> contenders;
  std::vector<Claim> claims;  ///< change nothing that is executed; reports compare them with fits
  std::vector<PublishedFigure> published;  ///< likewise

  [[nodiscard]] std::size_t cell_count() const noexcept {
    return models.size() * contenders.size() * settings.size() * seeds.size();
  }
};

/// Reads a config. A list where a value may stand is a sweep axis: planner parameters, planners,
/// `order`, task and printer keys, `seed`; all axes are multiplied, in the order in which they are
/// written, the last one running fastest.
///
/// Throws Error{kBadInput} in one line: file, line, key, what is wrong and what would be right
///        (the nearest known key); file, line and column for what is no TOML.
[[nodiscard]] ExperimentConfig load_config(const std::filesystem::path& file);

/// As load_config, from text; `file` stands in messages, and relative paths begin at its folder.
[[nodiscard]] ExperimentConfig parse_config(const std::string& text,
                                            const std::filesystem::path& file);

/// Checks planners and their parameters against what is registered.
/// Throws Error{kBadInput} with file, line and key.
void check_contenders(const ExperimentConfig& config, const Registry& registry);

/// The whole config with every default and every point of every axis, as JSON. The planners'
/// parameters are those that `registry` resolves. Call check_contenders first.
[[nodiscard]] std::string resolved_json(const ExperimentConfig& config, const Registry& registry);

}  // namespace routebench
