#pragma once
/// What stands in a results database, as lines that can be compared.

#include <gtest/gtest.h>
#include <sqlite3.h>

#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

#include "routebench/harness/metrics.hpp"

namespace routebench::test {

/// The rows of a query, columns with '|' between them, NULL as "NULL".
inline std::vector<std::string> rows_of(const std::filesystem::path& file, const std::string& sql) {
  sqlite3* database = nullptr;
  EXPECT_EQ(sqlite3_open(file.c_str(), &database), SQLITE_OK);
  sqlite3_busy_timeout(database, 10'000);
  sqlite3_stmt* statement = nullptr;
  EXPECT_EQ(sqlite3_prepare_v2(database, sql.c_str(), -1, &statement, nullptr), SQLITE_OK)
      << sqlite3_errmsg(database) << " in " << sql;
  std::vector<std::string> rows;
  while (sqlite3_step(statement) == SQLITE_ROW) {
    std::string row;
    for (int i = 0; i < sqlite3_column_count(statement); ++i) {
      const unsigned char* text = sqlite3_column_text(statement, i);
      row += (i == 0 ? "" : "|") +
             (text == nullptr ? std::string("NULL") : reinterpret_cast<const char*>(text));
    }
    rows.push_back(row);
  }
  sqlite3_finalize(statement);
  sqlite3_close(database);
  return rows;
}

/// Everything about the current cells that depends on neither time nor place: who they are, what
/// came of them, scores, routes, shapes, and which repetitions were timed. Ids, times and memory
/// are left out. Expects the file to be sound, with no row that belongs to nothing.
inline std::vector<std::string> current_content(const std::filesystem::path& file) {
  EXPECT_EQ(rows_of(file, "PRAGMA integrity_check"), std::vector<std::string>{"ok"});
  EXPECT_EQ(rows_of(file, "PRAGMA foreign_key_check"), std::vector<std::string>{});
  std::string measured, columns;
  for (const MetricInfo& metric : metric_table())
    if (is_deterministic(metric.name))
      columns += ", " + std::string(metric.name);
    else
      measured += (measured.empty() ? "'" : ", '") + std::string(metric.name) + "'";
  const std::string name = "spec, contender.name, label, current_cell.seed";
  const std::string cells =
      " FROM current_cell JOIN model USING(model_id) JOIN contender USING(contender_id)"
      " JOIN setting USING(setting_id)";
  std::vector<std::string> lines;
  for (const std::string& sql :
       {"SELECT " + name +
            ", cell_key, layers_hash, mesh_hash, variant_json, task_json, printer_json,"
            " plugin_hashes, outcome, reason, current_cell.layers, route_hash" +
            cells,
        "SELECT " + name + ", metric, quote(value)" + cells +
            " JOIN cell_score USING(cell_id) WHERE metric NOT IN (" + measured + ")",
        "SELECT " + name + ", layer_index, z_mm, repaired" + columns + cells +
            " JOIN layer_score USING(cell_id)",
        "SELECT " + name + ", 'repetition', repetition" + cells +
            " JOIN timing_sample USING(cell_id)",
        "SELECT " + name + ", layer_index, strokes_json" + cells + " JOIN route USING(cell_id)",
        std::string("SELECT spec, layers_hash, layer_index, wkt FROM layer_shape"
                    " JOIN model USING(model_id)")}) {
    const std::vector<std::string> rows = rows_of(file, sql);
    lines.insert(lines.end(), rows.begin(), rows.end());
  }
  std::sort(lines.begin(), lines.end());
  return lines;
}

}  // namespace routebench::test
