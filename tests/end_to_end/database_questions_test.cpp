// The questions of docs/database.md, as they stand there, asked of a real study: through `bedload query` and through pandas.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "tests/end_to_end/bedload_program.hpp"
#include "tests/end_to_end/tiny_study.hpp"
#include "tests/support/temporary_directory.hpp"

namespace bedload {
namespace {

namespace fs = std::filesystem;

/// Two diameters by bisection, and two pairs of the error budget.
const std::string searched_study = with(
    with(
        with(with(with(tiny_study, "[\"2000 kg/m3\", \"3000 kg/m3\"]", "\"3000 kg/m3\""), "count = 300", "count = 100"),
             "length = \"10 d\"", "length = \"6 d\""),
        "from = 0.1, ratio = 1.5, steps = 4", "from = 0.03, ratio = 1.5, steps = 9"),
    "[run]",
    "[onset]\nmethod = \"bisect\"\nbracket = 0.3\nhold = \"20 td\"\nbudget = [\"bracket\", \"mesh\"]\n[record]\n"
    "every = \"0.5 td\"\n[run]");

struct Question {
  std::string title, sql;
};

/// The statements below a heading of the document that begins so, up to the next of its level or higher, each with the last line of text before it.
std::vector<Question> questions_below(const std::string& heading) {
  std::istringstream document(contents(fs::path(BEDLOAD_SOURCE_DIR) / "docs" / "database.md"));
  std::vector<Question> found;
  std::string line, title;
  bool below = false, in_statement = false;
  while (std::getline(document, line)) {
    if (in_statement) {
      if (line == "```") in_statement = false;
      else found.back().sql += line + "\n";
    } else if (line.starts_with("## ") || line.starts_with(heading)) {
      below = line.starts_with(heading);
      title = line;
    } else if (line.starts_with("### ")) {
      below = below && heading.starts_with("## ");
      title = line;
    } else if (below && line == "```sql") {
      found.push_back({title, ""});
      in_statement = true;
    }
  }
  return found;
}

/// Rows of values, as pandas.read_sql has them; what it does not know is null.
constexpr auto read_by_pandas = R"(
import json, pandas, sqlite3, sys
database, statement = sys.argv[1:]
frame = pandas.read_sql(open(statement).read(), sqlite3.connect(f'file:{database}?mode=ro', uri=True))
plain = lambda value: None if pandas.isna(value) else value.item() if hasattr(value, 'item') else value
json.dump([{name: plain(value) for name, value in zip(frame.columns, row)}
           for row in frame.itertuples(index=False, name=None)], sys.stdout)
)";

class DatabaseQuestions : public testing::Test {
 protected:
  void SetUp() override {
    std::ofstream(here() / "tiny.toml") << searched_study;
    const auto ran = bedload(here(), {"run", "tiny.toml", "--cores", "2"});
    ASSERT_EQ(ran.code, 0) << ran.err;
    std::ofstream(here() / "read.py") << read_by_pandas;
  }
  nlohmann::ordered_json by_query(const std::string& sql) const {
    const auto asked = bedload(here(), {"query", "tiny.toml", sql, "--json"});
    EXPECT_EQ(asked.code, 0) << sql << asked.err;
    return nlohmann::ordered_json::parse(asked.out, nullptr, false);
  }
  nlohmann::ordered_json by_pandas(const std::string& sql) const {
    std::ofstream(here() / "ask.sql") << sql;
    const auto said = here() / "pandas.out";
    const auto command =
        "cd '" + here().string() + "' && /usr/bin/python3 read.py tiny/study.db ask.sql > pandas.out 2> pandas.err";
    EXPECT_EQ(std::system(command.c_str()), 0) << sql << contents(here() / "pandas.err");
    return nlohmann::ordered_json::parse(contents(said), nullptr, false);
  }
  const fs::path& here() const { return directory_.path(); }

 private:
  TemporaryDirectory directory_;
};

TEST_F(DatabaseQuestions, AreFiveAndAnswerWhatTheyAsk) {
  const auto all = questions_below("## Questions people ask"), more = questions_below("### More");
  ASSERT_EQ(all.size(), 5 + more.size());
  for (std::size_t n = 0; n < 5; ++n) {
    EXPECT_TRUE(all[n].title.starts_with("### " + std::to_string(n + 1) + ". ")) << all[n].title;
    EXPECT_GT(by_query(all[n].sql).size(), 0u) << all[n].title;
  }
  ASSERT_GT(more.size(), 0u);
  for (const Question& one : more) {
    const bool of_ramps = one.sql.find("at_1e_3") != std::string::npos;   // a search has one criterion
    EXPECT_EQ(by_query(one.sql).size() > 0, !of_ramps) << one.sql;
  }

  // both diameters, both pairs, a threshold with its bracket, motion measured and dying
  const auto curve = by_query(all[0].sql), budget = by_query(all[1].sql), transport = by_query(all[2].sql),
             motion = by_query(all[3].sql), cost = by_query(all[4].sql);
  ASSERT_EQ(curve.size(), 2u);
  EXPECT_EQ(curve[0]["status"], "bracketed") << curve.dump();
  EXPECT_GT(curve[0]["shields"], curve[0]["stop"]) << curve.dump();
  EXPECT_GT(curve[0]["systematic"], 0) << curve.dump();
  ASSERT_EQ(budget.size(), 2u);
  EXPECT_EQ(budget[0]["source"], "bracket");
  EXPECT_EQ(budget[1]["source"], "mesh");
  EXPECT_GT(budget[1]["size"], 0) << budget.dump();
  ASSERT_GT(transport.size(), 1u);
  EXPECT_LT(transport.front()["diameter_m"], transport.back()["diameter_m"]);
  for (const auto& hold : transport) EXPECT_GT(hold["transport"], 0) << hold.dump();
  std::size_t decays = 0;
  for (const auto& row : motion) {
    decays += row["decay_time_s"].is_number();
    EXPECT_GT(row["ten_percent"], 0) << row.dump();
    EXPECT_LE(row["first_grain_upper"], row["one_percent_upper"]) << row.dump();
    EXPECT_LE(row["one_percent_upper"], row["ten_percent_upper"]) << row.dump();
    EXPECT_GT(row["first_grain_upper"], 0) << row.dump();
  }
  EXPECT_GT(decays, 0u) << motion.dump();
  ASSERT_EQ(cost.size(), 4u);   // two cases and two pairs
  for (const auto& one : cost) {
    EXPECT_GT(one["core_h"], 0);
    EXPECT_LT(one["worst_shields"], 0.5) << one.dump();
  }
}

TEST_F(DatabaseQuestions, AreReadByPandasToTheSameValues) {
  if (std::system("/usr/bin/python3 -c 'import pandas' 2> /dev/null") != 0)
    GTEST_SKIP() << "this test needs the package python3-pandas (scripts/setup installs it)";
  for (const Question& one : questions_below("## Questions people ask")) {
    const auto ours = by_query(one.sql), theirs = by_pandas(one.sql);
    ASSERT_TRUE(ours.is_array() && theirs.is_array()) << one.sql;
    ASSERT_EQ(ours.size(), theirs.size()) << one.sql;
    for (std::size_t row = 0; row < ours.size(); ++row) {
      ASSERT_EQ(ours[row].size(), theirs[row].size()) << one.sql;
      for (const auto& [column, value] : ours[row].items())
        EXPECT_EQ(value, theirs[row].at(column)) << one.title << ", row " << row << ", " << column;
    }
  }
}

}   // namespace
}   // namespace bedload
