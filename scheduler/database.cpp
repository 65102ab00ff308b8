// The study's SQLite file: how it is opened, what a reader may do, and SQLite's errors in the program's own kinds.
#include "scheduler/database.hpp"

#include <SQLiteCpp/SQLiteCpp.h>
#include <fmt/format.h>
#include <sqlite3.h>
#include <sys/vfs.h>

#include <algorithm>
#include <array>
#include <cstring>

#include "base/error.hpp"

namespace bedload {
namespace {

constexpr int layout_version = 7;     // PRAGMA user_version: moves when a table changes its meaning
constexpr int patience_ms = 10'000;   // how long a statement waits for another process's transaction

/// WAL needs memory shared between all who open the file, which network file systems do not have (statfs(2) magics).
bool on_network_file_system(const std::filesystem::path& directory) {
  constexpr std::array<unsigned long, 11> network = {
      0x6969,       // NFS
      0xff534d42,   // CIFS
      0xfe534d42,   // SMB2
      0x517b,       // SMB
      0x0bd00bd0,   // Lustre
      0x47504653,   // GPFS
      0x01021997,   // 9p
      0x00c36400,   // Ceph
      0x19830326,   // BeeGFS
      0xaad7aaea,   // PanFS
      0x65735546,   // FUSE: sshfs and others
  };
  struct statfs info {};
  if (::statfs(directory.c_str(), &info) != 0) return false;
  const auto magic = static_cast<unsigned long>(info.f_type) & 0xffffffffUL;
  return std::ranges::find(network, magic) != network.end();
}

/// What a query may do: read rows and call functions. A read-only connection alone would still let VACUUM INTO and
/// ATTACH write files beside the database.
int allow_reading_only(void*, int action, const char*, const char* function, const char*, const char*) {
  switch (action) {
    case SQLITE_SELECT:
    case SQLITE_READ:
    case SQLITE_RECURSIVE: return SQLITE_OK;
    case SQLITE_FUNCTION: return std::strcmp(function, "load_extension") == 0 ? SQLITE_DENY : SQLITE_OK;
    default: return SQLITE_DENY;
  }
}

[[noreturn]] void rethrow(const SQLite::Exception& e, const std::filesystem::path& file, Database::Mode mode) {
  const auto text = fmt::format("{}: {}", file.string(), e.what());
  const char* const rebuild = "it can be rebuilt from the case directories: `bedload run STUDY --rescan`";
  switch (e.getErrorCode() & 0xff) {
    case SQLITE_AUTH:
      throw Error(ErrorKind::usage, fmt::format("{}: a query may only read", file.string()),
                  "use SELECT; to change or copy the database open it with sqlite3");
    case SQLITE_BUSY:
    case SQLITE_LOCKED: throw Error(ErrorKind::locked, text, "another process is writing to it; try again in a moment");
    case SQLITE_CORRUPT:
    case SQLITE_NOTADB: throw Error(ErrorKind::corrupt, text, rebuild);
    case SQLITE_CANTOPEN:
    case SQLITE_FULL:
    case SQLITE_IOERR:
    case SQLITE_PERM:
    case SQLITE_READONLY: throw Error(ErrorKind::io, text, "check free space and permissions of its directory");
    default: throw Error(mode == Database::Mode::query ? ErrorKind::usage : ErrorKind::internal, text);
  }
}

/// SQLite runs the first statement of a text and says nothing of the rest. A text that it cannot read is left for it to
/// refuse.
void refuse_all_but_one_statement(sqlite3* database, std::string_view sql) {
  int statements = 0;
  for (const char *rest = sql.data(), *const end = sql.data() + sql.size(); rest < end && statements < 2;) {
    sqlite3_stmt* statement = nullptr;
    const int code = sqlite3_prepare_v2(database, rest, static_cast<int>(end - rest), &statement, &rest);
    statements += statement != nullptr || code != SQLITE_OK;
    sqlite3_finalize(statement);
    if (code != SQLITE_OK) break;
  }
  if (statements == 1) return;
  throw Error(
      ErrorKind::usage,
      statements == 0 ? "the query is empty" : "the query has more than one statement, and one is run at a time",
      "a query is one statement, such as \"SELECT * FROM threshold_curve\"");
}

Value value_of(const SQLite::Column& column) {
  if (column.isNull()) return std::monostate{};
  if (column.isInteger()) return column.getInt64();
  if (column.isFloat()) return column.getDouble();
  return column.getString();
}

void bind(SQLite::Statement& statement, const std::vector<Value>& parameters) {
  for (int i = 0; i < static_cast<int>(parameters.size()); ++i) {
    const Value& value = parameters[static_cast<std::size_t>(i)];
    if (const auto* integer = std::get_if<std::int64_t>(&value)) statement.bind(i + 1, *integer);
    if (const auto* real = std::get_if<double>(&value)) statement.bind(i + 1, *real);
    if (const auto* text = std::get_if<std::string>(&value)) statement.bind(i + 1, *text);
  }   // a parameter that is not bound is NULL
}

}   // namespace

struct Database::Connection {
  Connection(const std::filesystem::path& path, Mode m)
      : file(path),
        mode(m),
        handle(path, m == Mode::write ? SQLite::OPEN_READWRITE | SQLite::OPEN_CREATE : SQLite::OPEN_READONLY,
               patience_ms) {}

  void prepare_for_writing() {
    const bool remote = on_network_file_system(std::filesystem::absolute(file).parent_path());
    handle.exec(remote ? "PRAGMA journal_mode = DELETE" : "PRAGMA journal_mode = WAL");
    handle.exec("PRAGMA synchronous = NORMAL");   // a lost tail is found again in the case directories
    handle.exec("PRAGMA foreign_keys = ON");
    if (is_new()) handle.exec(fmt::format("PRAGMA user_version = {}", layout_version));
  }

  void check_layout() {
    const int version = handle.execAndGet("PRAGMA user_version").getInt();
    if (version > layout_version)
      throw Error(
          ErrorKind::corrupt,
          fmt::format("{} is of a newer bedload: layout {}, this one knows {}", file.string(), version, layout_version),
          "use the bedload that wrote it");
    if (version > 0 && version < layout_version)
      throw Error(ErrorKind::corrupt,
                  fmt::format("{} is of an older bedload: layout {}, this one writes {}", file.string(), version,
                              layout_version),
                  "move it away: `bedload run STUDY` makes a new one from the case directories");
    if (version < layout_version && !(mode == Mode::write && is_new()))
      throw Error(ErrorKind::corrupt, fmt::format("{} is not the database of a study", file.string()),
                  "move it away; `bedload run` makes a new one from the case directories");
  }

  bool is_new() {
    return handle.execAndGet("PRAGMA user_version").getInt() == 0 &&
           handle.execAndGet("SELECT count(*) FROM sqlite_schema").getInt() == 0;
  }

  std::filesystem::path file;
  Mode mode;
  SQLite::Database handle;
  int transactions = 0;   // open ones, the inner as savepoints of the outer
};

Database::Database(const std::filesystem::path& file, Mode mode) try {
  if (mode == Mode::query && !std::filesystem::exists(file))
    throw Error(ErrorKind::not_found, fmt::format("there is no database {}", file.string()),
                "`bedload run STUDY` makes it");
  connection_ = std::make_unique<Connection>(file, mode);
  connection_->check_layout();
  if (mode == Mode::write) connection_->prepare_for_writing();
  if (mode == Mode::query) sqlite3_set_authorizer(connection_->handle.getHandle(), allow_reading_only, nullptr);
} catch (const SQLite::Exception& e) {
  rethrow(e, file, mode);
}

Database::~Database() = default;

void Database::execute(std::string_view sql, const std::vector<Value>& parameters) try {
  if (parameters.empty()) {   // possibly several statements, as in a schema
    connection_->handle.exec(std::string(sql));
    return;
  }
  SQLite::Statement statement(connection_->handle, std::string(sql));
  bind(statement, parameters);
  while (statement.executeStep()) continue;
} catch (const SQLite::Exception& e) {
  rethrow(e, connection_->file, connection_->mode);
}

Rows Database::query(std::string_view sql, const std::vector<Value>& parameters) const try {
  refuse_all_but_one_statement(connection_->handle.getHandle(), sql);
  SQLite::Statement statement(connection_->handle, std::string(sql));
  bind(statement, parameters);
  Rows result;
  for (int c = 0; c < statement.getColumnCount(); ++c) result.columns.emplace_back(statement.getColumnName(c));
  while (statement.executeStep()) {
    auto& row = result.rows.emplace_back();
    for (int c = 0; c < statement.getColumnCount(); ++c) row.push_back(value_of(statement.getColumn(c)));
  }
  return result;
} catch (const SQLite::Exception& e) {
  rethrow(e, connection_->file, connection_->mode);
}

Database::Transaction::Transaction(Database& database) : database_(&database) {
  database.execute(database.connection_->transactions == 0 ? "BEGIN IMMEDIATE" : "SAVEPOINT inner_transaction");
  ++database.connection_->transactions;
}

void Database::Transaction::commit() {
  database_->execute(database_->connection_->transactions == 1 ? "COMMIT" : "RELEASE inner_transaction");
  --database_->connection_->transactions;
  database_ = nullptr;
}

Database::Transaction::~Transaction() {
  if (!database_) return;
  auto& connection = *database_->connection_;
  const bool outermost = --connection.transactions == 0;
  connection.handle.tryExec(outermost ? "ROLLBACK"   // fails harmlessly where SQLite has rolled back by itself
                                      : "ROLLBACK TO inner_transaction; RELEASE inner_transaction");
}

}   // namespace bedload
