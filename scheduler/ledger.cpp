// Tables and views of the ledger, and the statements that change them.
#include "scheduler/ledger.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <set>

namespace bedload {
namespace {

constexpr std::string_view schema = R"sql(
CREATE TABLE IF NOT EXISTS cases (
  position        INTEGER PRIMARY KEY,             -- order of enrolment
  case_id         TEXT NOT NULL UNIQUE,            -- digest of its physics
  label           TEXT NOT NULL,
  kind            TEXT NOT NULL CHECK (kind IN ('bed', 'case')),
  directory       TEXT NOT NULL,                   -- relative to the study's
  bed_id          TEXT,                            -- the bed it starts on
  state           TEXT NOT NULL DEFAULT 'pending'
                  CHECK (state IN ('pending', 'running', 'done', 'failed', 'stopped', 'spare')),
  message         TEXT NOT NULL DEFAULT '',        -- why it failed or stopped
  in_study        INTEGER NOT NULL DEFAULT 1,      -- 0 = dropped from the study file, results kept
  parameters_json TEXT NOT NULL                    -- all of them; the main ones are columns to the right
) STRICT;

CREATE TABLE IF NOT EXISTS attempts (
  case_id       TEXT NOT NULL REFERENCES cases(case_id),
  number        INTEGER NOT NULL,
  host          TEXT NOT NULL,
  pid           INTEGER NOT NULL,
  start_utc     TEXT NOT NULL,
  end_utc       TEXT,
  cause         TEXT NOT NULL,                     -- why it ended
  message       TEXT NOT NULL,
  from_step     INTEGER,                           -- of the checkpoint it continued
  step          INTEGER,                           -- reached
  core_time_s   REAL NOT NULL,
  version       TEXT NOT NULL,
  compiler      TEXT NOT NULL,
  PRIMARY KEY (case_id, number)
) STRICT;

CREATE VIEW IF NOT EXISTS progress AS
  SELECT kind, state, count(*) AS count FROM cases WHERE in_study GROUP BY kind, state;

CREATE VIEW IF NOT EXISTS failures AS
  SELECT c.label, c.case_id, c.kind, c.message, a.cause, a.step, a.number AS attempts,
         c.directory || '/log.' || a.number AS log
  FROM cases c LEFT JOIN attempts a
    ON a.case_id = c.case_id AND a.number = (SELECT max(number) FROM attempts WHERE case_id = c.case_id)
  WHERE c.in_study AND c.state = 'failed' ORDER BY c.position;

CREATE VIEW IF NOT EXISTS cost AS
  SELECT c.label, c.case_id, c.kind, count(a.number) AS attempts, coalesce(sum(a.core_time_s), 0) / 3600 AS core_h,
         coalesce(sum(a.core_time_s) FILTER (WHERE a.cause NOT IN ('finished', 'stopped', 'wall_limit', 'running')), 0)
           / 3600 AS core_h_of_unplanned_ends
  FROM cases c LEFT JOIN attempts a USING (case_id) GROUP BY c.case_id ORDER BY c.position;
)sql";

constexpr std::array<std::string_view, 6> state_words = {"pending", "running", "done", "failed", "stopped", "spare"};

Value text_or_null(const std::string& text) { return text.empty() ? Value() : Value(text); }

Value integer_or_null(const std::optional<std::uint64_t>& number) {
  return number ? Value(static_cast<std::int64_t>(*number)) : Value();
}

std::string text_in(const Value& value) {
  const auto* text = std::get_if<std::string>(&value);
  return text ? *text : std::string();
}

bool is_column_name(std::string_view name) {
  return !name.empty() && name.find_first_not_of("abcdefghijklmnopqrstuvwxyz0123456789_") == std::string_view::npos;
}

std::set<std::string> columns_of_cases(const Database& database) {
  std::set<std::string> names;
  for (const auto& row : database.query("SELECT name FROM pragma_table_info('cases')").rows)
    names.insert(text_in(row[0]));
  return names;
}

}   // namespace

std::string_view word(CaseState state) { return state_words[static_cast<std::size_t>(state)]; }

std::vector<CaseEntry> read_cases(const Database& database) {
  if (database.query("SELECT 1 FROM sqlite_schema WHERE type = 'table' AND name = 'cases'").rows.empty()) return {};
  std::vector<CaseEntry> entries;
  for (const auto& row : database
                             .query("SELECT case_id, label, kind, directory, bed_id, parameters_json, state, message, "
                                    "in_study FROM cases ORDER BY position")
                             .rows) {
    CaseEntry& entry = entries.emplace_back();
    entry.id = text_in(row[0]);
    entry.label = text_in(row[1]);
    entry.is_bed = text_in(row[2]) == "bed";
    entry.directory = text_in(row[3]);
    entry.bed = text_in(row[4]);
    entry.parameters = text_in(row[5]);
    entry.state = static_cast<CaseState>(std::ranges::find(state_words, text_in(row[6])) - state_words.begin());
    entry.message = text_in(row[7]);
    entry.in_study = std::get<std::int64_t>(row[8]) != 0;
  }
  return entries;
}

Ledger::Ledger(Database& database, std::filesystem::path study) : database_(&database), study_(std::move(study)) {
  Database::Transaction transaction(database);
  database.execute(schema);
  transaction.commit();
}

void Ledger::add_columns(const std::vector<CaseEntry>& entries) {
  auto known = columns_of_cases(*database_);
  for (const auto& entry : entries)
    for (const auto& [name, value] : entry.columns) {
      if (!is_column_name(name)) throw Error(ErrorKind::internal, fmt::format("'{}' is no name for a column", name));
      if (!known.insert(name).second) continue;
      const char* const type = std::holds_alternative<std::string>(value)    ? "TEXT"
                               : std::holds_alternative<std::int64_t>(value) ? "INTEGER"
                                                                             : "REAL";
      database_->execute(fmt::format("ALTER TABLE cases ADD COLUMN {} {}", name, type));
    }
}

void Ledger::enrol(const std::vector<CaseEntry>& entries) {
  Database::Transaction transaction(*database_);
  add_columns(entries);
  database_->execute("UPDATE cases SET in_study = 0");
  for (const auto& entry : entries) {
    database_->execute(
        "INSERT INTO cases (case_id, label, kind, directory, bed_id, parameters_json) VALUES (?, ?, ?, ?, ?, ?) "
        "ON CONFLICT (case_id) DO UPDATE SET label = excluded.label, kind = excluded.kind, in_study = 1, "
        "directory = excluded.directory, bed_id = excluded.bed_id, parameters_json = excluded.parameters_json",
        {entry.id, entry.label, std::string(entry.is_bed ? "bed" : "case"), entry.directory.string(),
         text_or_null(entry.bed), entry.parameters});
    for (const auto& [name, value] : entry.columns)
      database_->execute(fmt::format("UPDATE cases SET {} = ? WHERE case_id = ?", name), {value, entry.id});
  }
  transaction.commit();
}

std::vector<CaseEntry> Ledger::cases() const {
  auto entries = read_cases(*database_);
  std::erase_if(entries, [](const CaseEntry& entry) { return !entry.in_study; });
  return entries;
}

void Ledger::set_state(const std::string& id, CaseState state, const std::string& message) {
  database_->execute("UPDATE cases SET state = ?, message = ? WHERE case_id = ?",
                     {std::string(word(state)), message, id});
}

void Ledger::record_attempts(const std::string& id, const std::vector<Attempt>& attempts) {
  Database::Transaction transaction(*database_);
  for (const auto& a : attempts)
    database_->execute(
        "INSERT OR REPLACE INTO attempts (case_id, number, host, pid, start_utc, end_utc, cause, message, from_step, "
        "step, "
        "core_time_s, version, compiler) VALUES (?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?)",
        {id, std::int64_t{a.number}, a.host, a.pid, a.start, text_or_null(a.end), std::string(word(a.cause)), a.message,
         integer_or_null(a.from_step), integer_or_null(a.step), a.core_seconds, a.version, a.compiler});
  transaction.commit();
}

}   // namespace bedload
