// The study's database: what a query may not do, and files of other versions.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <functional>

#include "base/error.hpp"
#include "scheduler/database.hpp"
#include "tests/support/temporary_directory.hpp"

namespace bedload {
namespace {

namespace fs = std::filesystem;

class StudyDatabase : public testing::Test {
 protected:
  static ErrorKind refusal(const std::function<void()>& action) {
    try {
      action();
    } catch (const Error& e) {
      return e.kind;
    }
    ADD_FAILURE() << "nothing was refused";
    return ErrorKind::internal;
  }

  InMemoryDirectory temporary_;
  fs::path directory_ = temporary_.path(), file_ = directory_ / "study.db";
};

TEST_F(StudyDatabase, GivesBackWhatWasWritten) {
  Database database(file_, Database::Mode::write);
  database.execute("CREATE TABLE t (a INTEGER, b REAL, c TEXT, d TEXT) STRICT; CREATE TABLE u (a INTEGER) STRICT;");
  const std::vector<Value> row = {std::int64_t{9007199254740993}, 0.1, std::string("0.1 µm"), std::monostate{}};
  database.execute("INSERT INTO t VALUES (?, ?, ?, ?)", row);
  const Rows rows = Database(file_, Database::Mode::query).query("SELECT * FROM t WHERE a = ?", {row[0]});
  EXPECT_EQ(rows.columns, (std::vector<std::string>{"a", "b", "c", "d"}));
  EXPECT_EQ(rows.rows, std::vector<std::vector<Value>>{row});
}

TEST_F(StudyDatabase, LetsQueriesReadAndNothingElse) {
  Database(file_, Database::Mode::write).execute("CREATE TABLE t (a INTEGER) STRICT; INSERT INTO t VALUES (1)");
  Database reader(file_, Database::Mode::query);
  EXPECT_EQ(reader
                .query("WITH RECURSIVE n(i) AS (SELECT 1 UNION ALL SELECT i + 1 FROM n WHERE i < 9) "
                       "SELECT max(i) + (SELECT count(*) FROM t) FROM n")
                .rows[0][0],
            Value(std::int64_t{10}));
  const fs::path other = directory_ / "other.db";
  for (const std::string& sql :
       {"VACUUM INTO '" + other.string() + "'", "ATTACH '" + other.string() + "' AS o", std::string("DELETE FROM t"),
        std::string("INSERT INTO t VALUES (2)"), std::string("DROP TABLE t"),
        std::string("CREATE TEMP TABLE s (a INTEGER)"), std::string("PRAGMA user_version = 7"),
        std::string("BEGIN IMMEDIATE"), std::string("SELECT load_extension('x')")}) {
    EXPECT_EQ(refusal([&] { reader.query(sql); }), ErrorKind::usage) << sql;
    EXPECT_EQ(refusal([&] { reader.execute(sql); }), ErrorKind::usage) << sql;
  }
  EXPECT_FALSE(fs::exists(other));
  EXPECT_EQ(reader.query("SELECT a FROM t").rows.size(), 1u);
}

TEST_F(StudyDatabase, RunsExactlyOneStatementOfAQuery) {
  const Database database(file_, Database::Mode::write);
  for (const char* sql :
       {"", "  ", ";", "-- nothing", "SELECT 1; SELECT 2", "SELECT 1; nonsense", "SELECT 1;; SELECT 2"})
    EXPECT_EQ(refusal([&] { database.query(sql); }), ErrorKind::usage) << sql;
  for (const char* sql : {"SELECT 1", "SELECT 1;", "SELECT 1 ; -- and no more\n", "/* first */ SELECT 1"})
    EXPECT_EQ(database.query(sql).rows.size(), 1u) << sql;
}

TEST_F(StudyDatabase, RefusesTheFileOfANewerVersion) {
  Database(file_, Database::Mode::write).execute("PRAGMA user_version = 99");
  EXPECT_EQ(refusal([&] { Database(file_, Database::Mode::write); }), ErrorKind::corrupt);
  EXPECT_EQ(refusal([&] { Database(file_, Database::Mode::query); }), ErrorKind::corrupt);
}

TEST_F(StudyDatabase, RefusesTheFileOfAnOlderLayoutAndSaysHowToGoOn) {
  Database(file_, Database::Mode::write).execute("PRAGMA user_version = 1");
  for (const auto mode : {Database::Mode::write, Database::Mode::query}) {
    try {
      Database(file_, mode);
      ADD_FAILURE() << "opened";
    } catch (const Error& error) {
      EXPECT_EQ(error.kind, ErrorKind::corrupt);
      EXPECT_NE(std::string(error.what()).find("layout 1"), std::string::npos) << error.what();
      EXPECT_NE(error.hint.find("bedload run"), std::string::npos) << error.hint;
    }
  }
}

TEST_F(StudyDatabase, RefusesAFileThatIsNoDatabase) {
  std::ofstream(file_) << std::string(5000, 'x');
  EXPECT_EQ(refusal([&] { Database(file_, Database::Mode::write); }), ErrorKind::corrupt);
  EXPECT_EQ(refusal([&] { Database(file_, Database::Mode::query); }), ErrorKind::corrupt);
}

TEST_F(StudyDatabase, SaysThatThereIsNone) {
  EXPECT_EQ(refusal([&] { Database(file_, Database::Mode::query); }), ErrorKind::not_found);
  EXPECT_FALSE(fs::exists(file_));
  EXPECT_EQ(refusal([&] { Database(directory_ / "nowhere" / "study.db", Database::Mode::write); }), ErrorKind::io);
}

TEST_F(StudyDatabase, RollsBackWhatWasNotCommitted) {
  Database database(file_, Database::Mode::write);
  database.execute("CREATE TABLE t (a INTEGER) STRICT");
  {
    Database::Transaction abandoned(database);
    database.execute("INSERT INTO t VALUES (1)");
  }
  {
    Database::Transaction outer(database);
    database.execute("INSERT INTO t VALUES (2)");
    {
      Database::Transaction abandoned(database);
      database.execute("INSERT INTO t VALUES (3)");
    }
    {
      Database::Transaction kept(database);
      database.execute("INSERT INTO t VALUES (4)");
      kept.commit();
    }
    outer.commit();
  }
  const Rows rows = Database(file_, Database::Mode::query).query("SELECT a FROM t ORDER BY a");
  EXPECT_EQ(rows.rows, (std::vector<std::vector<Value>>{{std::int64_t{2}}, {std::int64_t{4}}}));
}

}   // namespace
}   // namespace bedload
