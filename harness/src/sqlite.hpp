#pragma once
/// A thin hold on SQLite: handles that close themselves, errors that throw, types that match.

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

struct sqlite3;
struct sqlite3_stmt;

namespace routebench {

enum class OpenMode {
  kCreate,    ///< to read and write; made if it does not exist
  kExisting,  ///< to read and write
  kReadOnly,  ///< nothing is changed, but an interrupted write of another process is undone
};

class Database;

/// A prepared statement. Parameters are bound in order, rows are fetched one by one.
class Statement {
 public:
  Statement(Database& database, std::string_view sql);

  /// Binds the next parameter. Text is copied.
  Statement& bind(std::int64_t value);
  Statement& bind(double value);
  Statement& bind(std::string_view value);
  Statement& bind(const std::optional<double>& value);
  Statement& bind(const std::optional<std::string>& value);
  Statement& bind_null();

  /// True while there is a row.
  [[nodiscard]] bool next();
  /// Runs to the end and makes the statement ready to be bound again.
  void run();
  /// Makes the statement ready to be bound again.
  void reset();

  [[nodiscard]] std::int64_t integer(int column) const;
  [[nodiscard]] double real(int column) const;
  [[nodiscard]] std::string text(int column) const;
  [[nodiscard]] bool is_null(int column) const;
  [[nodiscard]] bool is_real(int column) const;
  [[nodiscard]] int columns() const;
  [[nodiscard]] std::string column_name(int column) const;

 private:
  void check(int code) const;

  struct Finalize {
    void operator()(sqlite3_stmt* statement) const;
  };
  Database* database_;
  std::unique_ptr<sqlite3_stmt, Finalize> statement_;
  int bound_ = 0;
};

/// An open database file.
class Database {
 public:
  /// Throws Error{kBadInput} naming the file if it cannot be opened or is no database.
  Database(const std::filesystem::path& file, OpenMode mode);

  /// Runs one or more statements without parameters.
  void run(const std::string& sql);

  [[nodiscard]] std::int64_t last_row() const;
  [[nodiscard]] const std::filesystem::path& file() const noexcept { return file_; }
  [[nodiscard]] sqlite3* handle() const noexcept { return handle_.get(); }

  /// Throws Error{kBadInput} with the file and what SQLite says of it.
  [[noreturn]] void fail(int code) const;

 private:
  struct Close {
    void operator()(sqlite3* handle) const;
  };
  std::filesystem::path file_;
  std::unique_ptr<sqlite3, Close> handle_;
};

/// All or nothing: what is written while it lives is undone unless commit() is called. What is read
/// is of one moment.
class Transaction {
 public:
  enum class Kind { kRead, kWrite };
  explicit Transaction(Database& database, Kind kind = Kind::kWrite);
  ~Transaction();
  Transaction(const Transaction&) = delete;
  Transaction& operator=(const Transaction&) = delete;
  void commit();

 private:
  Database* database_;
  bool open_ = true;
};

}  // namespace routebench
