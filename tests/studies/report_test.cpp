// The page: complete, self-contained, well-formed, with what the database says.
#include "studies/report.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <regex>
#include <set>
#include <sstream>

#include "studies/attempt_figure.hpp"
#include "studies/bed_picture.hpp"
#include "studies/report_figures.hpp"
#include "studies/results.hpp"
#include "studies/svg_plot.hpp"
#include "tests/support/temporary_directory.hpp"

namespace bedload {
namespace {

std::size_t occurrences(const std::string& text, const std::string& part) {
  std::size_t count = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++count;
  return count;
}

/// Every tag of a name is closed, or closes itself.
void expect_balanced(const std::string& page, const std::string& name) {
  const std::regex open("<" + name + "(\\s[^>]*[^/]|)>"), close("</" + name + ">");
  const auto number_of = [&](const std::regex& what) {
    return std::distance(std::sregex_iterator(page.begin(), page.end(), what), std::sregex_iterator());
  };
  EXPECT_EQ(number_of(open), number_of(close)) << name;
}

class ReportTest : public ::testing::Test {
 protected:
  ReportTest() { create_result_tables(database_); }
  void add_point(const std::string& set, const char* status, Value shields, Value lower, Value upper) {
    database_.execute(
        "INSERT INTO threshold_curve VALUES (?,5e-4,2,1e-5,0.5,'ramp','flux',0.01,3.5,1.4,?,NULL,NULL,NULL,NULL,0,?,?,"
        "NULL,NULL,NULL,NULL,NULL,?,1,1,0,0,0,?)",
        {set, shields, lower, upper, std::string(status), set});
  }
  void by_bisection(const std::string& set, Value systematic) {
    database_.execute("UPDATE threshold_curve SET method = 'bisect', systematic = ? WHERE parameter_set = ?",
                      {systematic, set});
  }
  void add_case() {
    database_.execute(
        "INSERT INTO scenes VALUES "
        "('c','label-c','set','set',1,5e-4,0,2000,1000,2,1e-5,9.81,3.5,1e5,1500,244,1,1,1,1,1,1,'stokes',1,1,1,0)");
    database_.execute(
        "INSERT INTO thresholds VALUES "
        "('c','flux',0.01,1,'bracketed',0.17,0.15,0.18,'ramp',NULL,NULL,0.58,4.5,NULL,NULL,NULL)");
    for (const auto* row : {"0,0,1,0.1,0.1,NULL,NULL,NULL,0,0,0,0,0,0", "1,1,2,0.2,0.2,0.2,0,1,0,0,0,0,0.5,0.1"})
      database_.execute(std::string("INSERT INTO ramp_points VALUES ('c',") + row +
                        ",0,0,0.1,0,0.003,0.003,NULL,0,0.0005,0.4,5,5,0,'ramp','none')");
    for (int z = 0; z < 4; ++z)
      database_.execute("INSERT INTO bed_statistics VALUES ('c',1,?,0.5,0.1,0.05,0)", {z * 1e-3});
    database_.execute("INSERT INTO models VALUES ('c',0,'drag',1,1,0.5,'a < b & c')");
  }
  std::string page() const { return report_html(database_, {"my <study>", "bedload run my.toml", "", {}, {}}); }

  TemporaryDirectory directory_;
  Database database_{directory_.path() / "study.db", Database::Mode::write};
};

TEST_F(ReportTest, SaysSoWhenNothingHasFinished) {
  EXPECT_NE(page().find("No case has finished yet"), std::string::npos);
}

TEST_F(ReportTest, FetchesNothing) {
  add_case();
  add_point("a", "bracketed", 0.17, 0.15, 0.18);
  for (const char* fetch : {"http:", "https:", "src=", "@import", "url(http"})
    EXPECT_EQ(page().find(fetch), std::string::npos) << fetch;
}

TEST_F(ReportTest, IsWellFormedAndEscapesWhatOthersWrote) {
  add_case();
  add_point("a<b", "bracketed", 0.17, 0.15, 0.18);
  const std::string html = page();
  for (const char* tag : {"svg", "g", "table", "tr", "td", "section", "div", "text"}) expect_balanced(html, tag);
  EXPECT_NE(html.find("my &lt;study&gt;"), std::string::npos);
  EXPECT_NE(html.find("a &lt; b &amp; c"), std::string::npos);
  EXPECT_EQ(html.find("a<b"), std::string::npos);
  EXPECT_FALSE(std::regex_search(html, std::regex("\\bnan\\b")));
}

// A name without a colour is black on any page; a colour without a name cannot follow the page into the dark.
TEST_F(ReportTest, TakesEveryColourFromTheTheme) {
  add_case();
  add_point("a", "bracketed", 0.17, 0.15, 0.18);
  add_point("b", "censored_above", Value(), 0.44, Value());
  const std::string html = page();
  const std::regex used("var\\((--[a-z-]+)\\)");
  std::set<std::string> names;
  for (auto at = std::sregex_iterator(html.begin(), html.end(), used); at != std::sregex_iterator(); ++at)
    names.insert((*at)[1]);
  EXPECT_GT(names.size(), 10u);
  for (const std::string& name : names)   // once for light, once for dark
    EXPECT_EQ(occurrences(html, " " + name + ": #"), 2u) << name;
  EXPECT_FALSE(std::regex_search(html.substr(html.find("</style>")), std::regex("['\"]#[0-9a-f]{3,8}['\"]")));
  EXPECT_NE(html.find("@media screen and (prefers-color-scheme: dark)"), std::string::npos);   // paper stays light
}

TEST_F(ReportTest, LetsWhatIsWideScrollWithinThePage) {
  add_case();
  add_point("a", "bracketed", 0.17, 0.15, 0.18);
  const std::string html = page();
  EXPECT_EQ(occurrences(html, "<table>"), occurrences(html, "<div class='scroll'><table>"));
  EXPECT_EQ(occurrences(html, "<svg class='plot'"), occurrences(html, "<div class='scroll'><svg class='plot'"));
  EXPECT_GT(occurrences(html, "<svg class='plot'"), 3u);
}

TEST_F(ReportTest, ShowsValuesFilledAndOneSidedBoundsOpen) {
  add_point("a", "bracketed", 0.17, 0.15, 0.18);
  add_point("b", "censored_above", Value(), 0.44, Value());
  const std::string html = page();
  EXPECT_NE(html.find("a: theta_c = 0.1700, between 0.1500 and 0.1800"), std::string::npos);
  EXPECT_NE(html.find("onset: flux &gt;= 0.01 per surface grain and td, by a ramp (screening); cells 0.5 d high"),
            std::string::npos);
  const std::size_t bound = html.find("b: theta_c &gt; 0.4400");
  ASSERT_NE(bound, std::string::npos);
  EXPECT_NE(html.substr(bound - 140, 140).find("fill='var(--paper)'"), std::string::npos);
}

TEST_F(ReportTest, SaysBoundsThatAreThereAndNoOthers) {
  add_point("a", "bracketed", 0.15, Value(), 0.1614);
  add_point("b", "bracketed", 0.15, 0.14, Value());
  add_point("c", "noisy", 0.15, Value(), Value());
  const std::string html = page();
  for (const char* part :
       {"a: theta_c = 0.1500, below 0.1614 at", "b: theta_c = 0.1500, above 0.1400 at", "c: theta_c = 0.1500 at"})
    EXPECT_NE(html.find(part), std::string::npos) << part;
  EXPECT_FALSE(std::regex_search(html, std::regex("\\bnan\\b")));
}

TEST_F(ReportTest, LabelsThresholdsOfRampsAsScreening) {
  add_point("a", "bracketed", 0.17, 0.15, 0.18);
  EXPECT_NE(page().find("<h2>Threshold of motion: screening by ramps</h2>"), std::string::npos);
  EXPECT_NE(page().find(">this study: ramp (screening)<"), std::string::npos);
  EXPECT_NE(page().find("bracketed (1 seed, screening)"), std::string::npos);
  EXPECT_EQ(page().find(">this study: bisection<"), std::string::npos);
  by_bisection("a", Value());
  EXPECT_NE(page().find("<h2>Threshold of motion</h2>"), std::string::npos);
  EXPECT_NE(page().find(">this study: bisection<"), std::string::npos);
  EXPECT_EQ(page().find(">this study: ramp (screening)<"), std::string::npos);
}

// From the bound that is known to theta_50, and an arrow on the other side.
TEST_F(ReportTest, DrawsBarsThatAreOpenAtOneEnd) {
  add_point("a", "bracketed", 0.1, 0.09, Value());
  const std::string html = page();
  const double middle = 464 * 0.5, lower = 464 * (1 - std::log(9.0) / std::log(100.0));
  std::smatch bar, arrow;
  ASSERT_TRUE(std::regex_search(html, bar,
                                std::regex("d='M[0-9.]+ ([0-9.]+)V([0-9.]+)[^']*' stroke='[^']*' stroke-width='1.4'")));
  EXPECT_NEAR(std::stod(bar[1]), lower, 0.06);
  EXPECT_NEAR(std::stod(bar[2]), middle, 0.06);
  ASSERT_TRUE(std::regex_search(html, arrow,
                                std::regex("d='M[0-9.]+ ([0-9.]+)V([0-9.]+)[^']*' stroke='[^']*' stroke-width='1.6'")));
  EXPECT_NEAR(std::stod(arrow[1]), middle, 0.06);
  EXPECT_LT(std::stod(arrow[2]), middle);   // y points down: towards higher Shields numbers
}

// The thin bar reaches from theta (1 - e) to theta (1 + e), with e the relative error of the table.
TEST_F(ReportTest, DrawsTheSystematicErrorBesideTheInterval) {
  const auto thin_bar = [&] {
    const std::regex path("d='M[0-9.]+ ([0-9.]+)V([0-9.]+)[^']*' stroke='[^']*' stroke-width='1' stroke-opacity");
    const std::string html = page();
    std::smatch found;
    const bool there = std::regex_search(html, found, path);
    return there ? std::pair(std::stod(found[1]), std::stod(found[2])) : std::pair(0.0, 0.0);
  };
  add_point("a", "bracketed", 0.1, 0.09, 0.11);
  by_bisection("a", Value());
  EXPECT_EQ(thin_bar().first, 0);   // mesh not tested: nothing to draw
  by_bisection("a", 0.5);
  const auto [low, high] = thin_bar();
  EXPECT_GT(low, high);   // y points down; both from an axis of two decades, 464 pixels high
  EXPECT_NEAR(low, 464 * (1 - std::log(0.05 / 0.01) / std::log(100.0)), 0.06);
  EXPECT_NEAR(high, 464 * (1 - std::log(0.15 / 0.01) / std::log(100.0)), 0.06);
  by_bisection("a", 1.5);   // down to nothing: the bar ends at the lower edge of the figure
  EXPECT_NEAR(thin_bar().first, 464, 0.06);
}

/// Slopes, meshes or terms of one grain lie over each other on the curve: they are drawn row by row too.
TEST_F(ReportTest, DrawsWaysOfLookingAtOneGrainSideBySide) {
  add_point("slope0", "bracketed", 0.12, 0.1, 0.14);
  EXPECT_FALSE(of_one_grain(threshold_curve(database_)));
  add_point("slope8", "bracketed", 0.09, 0.08, 0.1);
  add_point("slope9", "censored_below", Value{}, Value{}, 0.05);
  const auto curve = threshold_curve(database_);
  ASSERT_TRUE(of_one_grain(curve));
  const std::string figure = side_by_side_figure(curve);
  for (const auto* set : {"slope0", "slope8", "slope9"})
    EXPECT_NE(figure.find(std::string(">") + set + "<"), std::string::npos) << figure;
  EXPECT_NE(figure.find("slope9: theta_c &lt; 0.0500"), std::string::npos) << figure;
  EXPECT_EQ(occurrences(figure, "<circle"), 5u);   // two of them in the legend
  EXPECT_EQ(occurrences(figure, "fill='var(--paper)' stroke='var(--blue)'"), 2u) << "one open, one in the legend";
  database_.execute("UPDATE threshold_curve SET diameter_m = 1e-3 WHERE parameter_set = 'slope9'");
  EXPECT_FALSE(of_one_grain(threshold_curve(database_)));
}

TEST_F(ReportTest, SaysARangeOnlyWhereThereIsOne) {
  add_case();
  add_point("a", "bracketed", 0.17, 0.15, 0.18);
  EXPECT_NE(page().find("1 finished case, θc = 0.170<"), std::string::npos);
  add_point("b", "bracketed", 0.19, 0.15, 0.2);
  EXPECT_NE(page().find("1 finished case, θc from 0.170 to 0.190<"), std::string::npos);
}

TEST_F(ReportTest, KnowsFinishedCasesThatSeekNoOnset) {
  add_case();
  database_.execute("DELETE FROM thresholds");
  EXPECT_NE(page().find("1 finished case, no onset sought"), std::string::npos);
  EXPECT_NE(page().find("No finished case seeks an onset"), std::string::npos);
}

// The database counts holds from 0 and calls the settled bed -1; this case's profiles are of hold 1 there.
TEST_F(ReportTest, CountsHoldsFromOne) {
  add_case();
  const std::string html = page();
  EXPECT_NE(html.find("after hold 2<"), std::string::npos);
  EXPECT_NE(html.find("fluid, hold 2<"), std::string::npos);
}

TEST_F(ReportTest, NamesWhatItsFluxFiguresShowWhateverTheMethod) {
  add_case();
  EXPECT_NE(page().find("<h2>Flux of every hold</h2>"), std::string::npos);
  EXPECT_EQ(page().find("<h2>Ramps</h2>"), std::string::npos);
  EXPECT_EQ(occurrences(page(), "<title>ramp, theta = "), 2u);
  database_.execute("UPDATE ramp_points SET purpose = 'staircase' WHERE hold = 1");
  const std::string html = page();
  const auto title = html.find("<title>staircase, theta = 0.2000");
  ASSERT_NE(title, std::string::npos);
  EXPECT_TRUE(html.substr(html.rfind('<', title - 1)).starts_with("<rect "));
}

TEST_F(ReportTest, HasATableOfMovers) {
  add_case();
  EXPECT_EQ(page().find("Movers, flux law"), std::string::npos);
  database_.execute(
      "INSERT INTO thresholds VALUES "
      "('c','moved_grains',1,0,'bracketed',0.123,0.1,0.15,'ramp',NULL,NULL,0.58,4.5,NULL,NULL,NULL)");
  database_.execute("INSERT INTO flux_laws VALUES ('c', 3, 0.104, 0.005, 1, 0.1, 4)");
  const std::string html = page();
  EXPECT_NE(html.find("<h2>Movers, flux law and the decay of motion</h2>"), std::string::npos);
  EXPECT_NE(html.find("<td>set</td><td class='n'>0.1230</td>"), std::string::npos);
  EXPECT_NE(html.find("<td class='n'>3</td><td class='n'>0.1040 +- 0.005</td>"), std::string::npos);
  EXPECT_EQ(html.find("<br>"), std::string::npos);   // of one seed there is no range
  database_.execute(
      "INSERT INTO scenes SELECT 'c2', label, parameter_set, set_label, 2, diameter_m, spread, "
      "grain_density_kg_per_m3, fluid_density_kg_per_m3, density_ratio, viscosity_m2_per_s, gravity_m_per_s2, "
      "galileo, young_modulus_pa, grains, surface_grains, length_m, width_m, height_m, cell_x_m, cell_y_m, "
      "cell_z_m, drag_law, dwell_s, dem_step_s, fluid_step_limit_s, retries FROM scenes");
  database_.execute(
      "INSERT INTO thresholds SELECT 'c2', criterion, value, decides, 'censored_above', NULL, 0.2, NULL, "
      "method, NULL, NULL, NULL, NULL, NULL, NULL, NULL FROM thresholds WHERE criterion = 'moved_grains'");
  EXPECT_NE(page().find("<td>set</td><td class='n'>&gt; 0.1615<br>(0.1230-&gt;0.2000)</td>"), std::string::npos);
}

// One hold with transport, and one without.
TEST_F(ReportTest, HasTheTradeOfAStudyThatMakesOne) {
  EXPECT_EQ(occurrences(page(), "Trade of speed against accuracy"), 0u);
  Trade trade{.study = "t", .settings = {{.name = "finest", .packings = 2}, {.name = "fast & bad", .packings = 2}}};
  trade.settings[0].core_seconds = 100, trade.settings[1].core_seconds = 25;
  trade.settings[1].theta = {0.3, 0.2, 0.4};
  trade.settings[0].frontier = trade.settings[1].frontier = true;
  const auto html = report_html(database_, {.study = "t", .trade = trade});
  for (const auto* part : {"Trade of speed against accuracy", "<td>* fast &amp; bad</td>", "<td class='n'>25%</td>",
                           "<td class='n'>+30%</td>", ">1 fast &amp; bad +30%<"})
    EXPECT_EQ(occurrences(html, part), 1u) << part;
  EXPECT_EQ(occurrences(html, "fast & bad"), 0u);
  EXPECT_FALSE(std::regex_search(html.substr(html.find("</style>")), std::regex("['\"]#[0-9a-f]{3,8}['\"]")));
}

TEST_F(ReportTest, DrawsTransportOverShieldsNumber) {
  EXPECT_EQ(transport_figure(database_), "");
  add_case();
  EXPECT_EQ(transport_figure(database_), "");
  database_.execute("UPDATE ramp_points SET transport = 0.5, transport_error = 0.1 WHERE hold = 1");
  const std::string figure = transport_figure(database_);
  EXPECT_EQ(occurrences(figure, "<title>label-c: q* = 0.5 ± 0.1 at theta = 0.2000<"), 1u);
  EXPECT_EQ(occurrences(figure, "<title>"), 1u);
  EXPECT_NE(figure.find(">d = 0.5 mm, s = 2<"), std::string::npos);
  EXPECT_NE(page().find(figure), std::string::npos);
  database_.execute("INSERT INTO variations VALUES ('c', 'mesh', 'b')");
  EXPECT_EQ(transport_figure(database_), "");
}

// A bed that rises from 2 mm to 3 mm, four diameters to six, by two samples.
TEST_F(ReportTest, DrawsTheHeightOfTheBedInTime) {
  add_case();
  EXPECT_EQ(height_figure(database_, {"c", "label-c", 5e-4}), "");
  database_.execute(
      "INSERT INTO samples VALUES ('c', 0.5, 0, 0.1, 0.1, 0, 0, 0, 2e-3, 0, 5, 0, 0, 0),"
      "('c', 1.5, 1, 0.2, 0.2, 0, 0, 0, 3e-3, 0, 5, 0, 0, 0)");
  const std::string figure = height_figure(database_, {"c", "label-c", 5e-4});
  std::smatch line;
  ASSERT_TRUE(std::regex_search(figure, line, std::regex("d='M[0-9.]+ ([0-9.]+)L[0-9.]+ ([0-9.]+)' fill='none'")));
  EXPECT_NEAR(std::stod(line[1]), 244 * (1 - 0.05 / 2.1), 0.06);   // 244 pixels for 3.95 to 6.05 diameters
  EXPECT_NEAR(std::stod(line[2]), 244 * 0.05 / 2.1, 0.06);
}

// Eleven samples of 100 exp(-t/0.2 s) moving grains in a hold that begins at 1 s; the figure's axes end at 1 s and 130 grains.
TEST_F(ReportTest, DrawsMovingGrainsWithTheDecayFittedToThem) {
  add_case();
  const FinishedCase of{"c", "label-c", 5e-4};
  EXPECT_EQ(decay_figure(database_, of), "");
  for (int n = 0; n <= 10; ++n)
    database_.execute("INSERT INTO samples VALUES ('c', ?, 1, 0.2, 0.2, 0, ?, 0, 0, 0, 5, 0, 0, 0)",
                      {1 + 0.1 * n, 100 * std::exp(-0.5 * n) / 244});
  database_.execute("INSERT INTO motion_decay VALUES ('c', 1, 0.2, 0.01, 100, 0, 11)");
  const std::string figure = decay_figure(database_, of);
  EXPECT_NE(figure.find(">hold 2 (ramp), θ = 0.2<"), std::string::npos) << figure;
  EXPECT_NE(figure.find(">T = 0.2 ± 0.01 s<"), std::string::npos);
  const std::regex line("<path d='M([0-9.]+) ([0-9.]+)(L[0-9. L]*)' fill='none'");
  std::vector<std::vector<PlotPoint>> lines;
  for (auto at = std::sregex_iterator(figure.begin(), figure.end(), line); at != std::sregex_iterator(); ++at) {
    auto& points = lines.emplace_back();
    std::string path = "L" + (*at)[1].str() + " " + (*at)[2].str() + (*at)[3].str();
    std::ranges::replace(path, 'L', ' ');
    std::istringstream numbers(path);
    for (PlotPoint p{}; numbers >> p.x >> p.y;) points.push_back(p);
  }
  ASSERT_EQ(lines.size(), 2u);
  ASSERT_EQ(lines[0].size(), 11u);
  EXPECT_NEAR(lines[0][0].y, 244 * (1 - std::log(100 / 0.3) / std::log(130 / 0.3)), 0.06);   // 244 pixels high
  const std::size_t steps = lines[1].size() / 10;
  for (std::size_t n = 0; n <= 10; ++n) {   // the samples lie on the curve
    EXPECT_NEAR(lines[1][n * steps].x, lines[0][n].x, 0.11);
    EXPECT_NEAR(lines[1][n * steps].y, lines[0][n].y, 0.11);
  }
  EXPECT_NE(page().find(figure), std::string::npos);
}

TEST_F(ReportTest, NamesEveryPublishedCurve) {
  for (const char* name :
       {"Soulsby 1997", "Brownlie 1981", "Parker 2003", "Cao 2006", "Guo 2002", "van Rijn 1984", "0.12 ± 0.03"})
    EXPECT_NE(page().find(name), std::string::npos) << name;
}

TEST_F(ReportTest, LeavesOutCasesThatLeftTheStudy) {
  add_case();
  EXPECT_NE(page().find("label-c"), std::string::npos);
  database_.execute("CREATE TABLE cases (case_id TEXT, in_study INTEGER)");
  database_.execute("INSERT INTO cases VALUES ('c', 0)");
  EXPECT_EQ(page().find("label-c"), std::string::npos);
}

TEST_F(ReportTest, SaysWhichCasesAreOutOfRange) {
  add_case();
  EXPECT_EQ(page().find("Range and missing terms"), std::string::npos);
  database_.execute("CREATE TABLE cases (case_id TEXT, position INTEGER, label TEXT, in_study INTEGER)");
  database_.execute("INSERT INTO cases VALUES ('c', 1, 'later', 1), ('b', 0, 'first', 1), ('a', 2, 'gone', 0)");
  for (const char* id : {"a", "b", "c"})
    database_.execute("INSERT INTO warnings VALUES (?, 0, ?)", {std::string(id), std::string("Re > 1 & more")});
  const std::string html = page();
  EXPECT_NE(html.find("Range and missing terms"), std::string::npos);
  EXPECT_NE(html.find("<td>first and 1 more</td><td>Re &gt; 1 &amp; more</td>"), std::string::npos);
}

BedView two_grains() {
  BedView view{.moment = "at rest", .grains = {}, .length = {10, 20, 5}, .diameter = 1, .speed_scale = 1};
  view.grains.resize(2);
  view.grains.position = {{4, 1, 1}, {5, 12, 1}};   // the second lies behind the slice of five diameters
  view.grains.diameter = {1, 1};
  return view;
}

// Two attempts at one case, of 40 s and 60 s, the first one killed; the second case still runs.
TEST_F(ReportTest, DrawsAttemptsInTime) {
  EXPECT_EQ(attempt_figure(database_), "");
  database_.execute("CREATE TABLE cases (case_id TEXT, position INTEGER, label TEXT, in_study INTEGER)");
  database_.execute(
      "CREATE TABLE attempts (case_id TEXT, number INTEGER, start_utc TEXT, end_utc TEXT, cause TEXT, core_time_s "
      "REAL)");
  EXPECT_EQ(attempt_figure(database_), "");
  database_.execute("INSERT INTO cases VALUES ('b', 1, 'second', 1), ('a', 0, 'first <1>', 1)");
  database_.execute(
      "INSERT INTO attempts VALUES ('a', 1, '2026-01-01T23:59:00Z', '2026-01-01T23:59:40Z', 'killed', 1),"
      "('a', 2, '2026-01-02T00:00:00Z', '2026-01-02T00:01:00Z', 'finished', 1),"
      "('b', 1, '2026-01-02T00:00:40Z', NULL, 'running', 1)");
  const std::string figure = attempt_figure(database_);
  struct Drawn {
    double x, y, width;
    std::string colour, title;
  };
  std::vector<Drawn> bars;
  const std::regex bar(
      "<rect x='([0-9.]+)' y='([0-9.]+)' width='([0-9.]+)' height='[0-9.]+' fill='([^']*)' [^>]*><title>([^<]*)<");
  for (auto at = std::sregex_iterator(figure.begin(), figure.end(), bar); at != std::sregex_iterator(); ++at)
    bars.push_back({std::stod((*at)[1]), std::stod((*at)[2]), std::stod((*at)[3]), (*at)[4], (*at)[5]});
  ASSERT_EQ(bars.size(), 3u);
  EXPECT_EQ(bars[0].title, "first &lt;1&gt;, attempt 1: killed, 40 s");
  EXPECT_EQ(bars[2].title, "second, attempt 1: running, 20 s");   // until the last time that is known
  EXPECT_EQ(bars[0].x, 0);
  EXPECT_NEAR(bars[1].x / bars[0].width, 60.0 / 40, 0.01);
  EXPECT_NEAR(bars[1].width / bars[0].width, 60.0 / 40, 0.01);
  EXPECT_NEAR(bars[2].x / bars[0].width, 100.0 / 40, 0.01);
  EXPECT_EQ(bars[0].y, bars[1].y);
  EXPECT_GT(bars[2].y, bars[1].y);
  EXPECT_NE(bars[0].colour, bars[1].colour);
  EXPECT_NE(page().find(figure), std::string::npos);
}

TEST_F(ReportTest, ShowsTheBedsOfACaseSideBySide) {
  BedView later = two_grains();
  later.moment = "after hold 3 <of 4>";
  const std::string html = report_html(
      database_, {"study", "bedload run my.toml", "", {{"case <1>", {two_grains(), later}}, {"case 2", {later}}}});
  const auto first = html.find("<h3>case &lt;1&gt;</h3>"), second = html.find("<h3>case 2</h3>");
  ASSERT_LT(first, second);
  const std::string of_first = html.substr(first, second - first);
  EXPECT_LT(of_first.find("at rest"), of_first.find("after hold 3 &lt;of 4&gt;"));
  EXPECT_EQ(occurrences(of_first, "<svg class='bed'"), 2u);
  EXPECT_EQ(occurrences(of_first, "<div class='row'>"), 1u);
  EXPECT_EQ(occurrences(html.substr(second), "<svg class='bed'"), 1u);
}

TEST(BedPicture, ShowsTheFrontSlice) { EXPECT_EQ(occurrences(bed_picture(two_grains(), 100), "<circle"), 1u); }

TEST(BedPicture, ShowsAGrainAcrossTheSeamAtBothEnds) {
  BedView view = two_grains();
  view.grains.position[0].x = 9.9;
  EXPECT_EQ(occurrences(bed_picture(view, 100), "<circle"), 2u);
}

TEST(BedPicture, ColoursAMovingGrainUnlikeAStillOne) {
  BedView moving = two_grains();
  moving.grains.velocity[0] = {0.5, 0, 0};
  EXPECT_NE(bed_picture(moving, 100), bed_picture(two_grains(), 100));
}

TEST(SvgPlot, StandsAloneWithoutThePagesColours) {
  SvgPlot plot(184, 156, {"x", 1, 100, true}, {"y", 0, 2, false});
  plot.marker({10, 0.5}, Marker::circle, "var(--blue)", false, "here");
  const std::string file = standing_alone(plot.svg());
  EXPECT_NE(file.find("fill='#ffffff' stroke='#0072b2'"), std::string::npos);
  EXPECT_EQ(file.find("var("), std::string::npos);
}

TEST(BedPicture, PutsAHazeBetweenNearAndFarGrains) {
  BedView view = two_grains();
  view.grains.position[1].y = 4;
  const std::string both = bed_picture(view, 100);
  const auto far = both.find("cx='50.0'"), near = both.find("cx='40.0'");
  ASSERT_LT(far, near);
  EXPECT_EQ(occurrences(both.substr(far, near - far), "opacity="), 5u);   // of 8 in five diameters
}

TEST(SvgPlot, PutsDataWhereItsAxesSay) {
  SvgPlot plot(184, 156, {"x", 1, 100, true}, {"y", 0, 2, false});   // a plotting area of 100 x 100 pixels
  plot.marker({10, 0.5}, Marker::circle, "#000", true, "here");
  EXPECT_NE(plot.svg().find("cx='50.0' cy='75.0'"), std::string::npos);
  plot.marker({1000, 0.5}, Marker::circle, "#000", true, "outside");
  EXPECT_EQ(plot.svg().find("outside"), std::string::npos);
}

}   // namespace
}   // namespace bedload
