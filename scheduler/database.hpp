// The study's SQLite file: the only place that includes SQLiteCpp.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace bedload {

using Value = std::variant<std::monostate, std::int64_t, double, std::string>;   // NULL, INTEGER, REAL, TEXT

struct Rows {
  std::vector<std::string> columns;
  std::vector<std::vector<Value>> rows;
};

class Database {
 public:
  /// `query` refuses (by an authorizer) everything that is not a SELECT and opens read only.
  enum class Mode { write, query };
  Database(const std::filesystem::path&, Mode);
  ~Database();

  void execute(std::string_view sql, const std::vector<Value>& parameters = {});
  /// One statement: an empty text, or a second statement, is Error usage.
  Rows query(std::string_view sql, const std::vector<Value>& parameters = {}) const;

  /// RAII: rolls back unless committed.
  class Transaction {
   public:
    explicit Transaction(Database&);
    ~Transaction();
    void commit();

   private:
    Database* database_;
  };

 private:
  struct Connection;
  std::unique_ptr<Connection> connection_;
};

}   // namespace bedload
