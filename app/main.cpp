// The command line: which commands there are, what they take, how they end. The only file that includes CLI11.
#include <algorithm>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include "app/commands.hpp"
#include "base/build_info.hpp"
#include "base/error.hpp"
#include "base/log.hpp"
#include "solver/state.hpp"
#include "studies/study_keys.hpp"

namespace bedload {

namespace {

std::string version_text() {
  const auto b = build_info();
  return fmt::format("bedload {} ({}, {}), physics_version {}\ncompiler {}\nflags {}\nlibraries {}", b.version,
                     b.commit, b.build_type, physics_version, b.compiler, b.flags, b.libraries);
}

constexpr int most_workers = 4096;

/// What CLI11 asks of a number of workers: the complaint, or nothing.
std::string check_workers(const std::string& given) {
  int workers = 0;
  const bool fits = CLI::detail::lexical_cast(given, workers) && workers >= 1 && workers <= most_workers;
  return fits ? "" : fmt::format("{} is not a number of workers from 1 to {}", given, most_workers);
}

[[noreturn]] void not_in_this_version(const std::string& command) {
  throw Error(ErrorKind::unavailable, fmt::format("`bedload {}` is not in this version", command),
              "`bedload --help` lists the commands");
}

/// What the command line says, and the command that it names.
struct CommandLine {
  CommandLine();

  CLI::App app{
      "bedload: when does a sediment bed begin to move? Coupled CFD-DEM, from a study file to a threshold curve.",
      "bedload"};
  int code = 0;

 private:
  using Run = std::function<int()>;
  CLI::App* add(const std::string& name, const std::string& what, const std::string& example, Run);
  void study_argument(CLI::App*);
  void forms(CLI::App*, bool csv = true);
  void study_commands();
  void result_commands();
  void validate_commands();
  void case_commands();
  void later_commands();

  RunOptionsOfCommand run_;
  ValidateOptions validate_;
  StudyOptions& study_ = run_.study;
  std::string name_, directory_, sql_, checkpoint_, viewed_;
  std::optional<std::string> until_;
  std::optional<double> budget_;
  bool watch_ = false, digest_ = false, verify_ = false, csv_ = false, json_ = false, svg_ = false, quiet_ = false,
       verbose_ = false;
};

CLI::App* CommandLine::add(const std::string& name, const std::string& what, const std::string& example, Run run) {
  auto* command = app.add_subcommand(name, what);
  command->footer("Example:\n  " + example);
  command->fallthrough();   // -q and -v after the command
  command->callback([this, run] {
    set_verbosity(quiet_ ? Verbosity::quiet : verbose_ ? Verbosity::verbose : Verbosity::normal);
    run_.quiet = quiet_;
    study_.form = json_ ? Form::json : csv_ ? Form::csv : svg_ ? Form::svg : Form::table;
    code = run();
  });
  return command;
}

void CommandLine::study_argument(CLI::App* command) {
  command->add_option("STUDY", study_.study, "study file, or its result directory")->required();
  command->add_option("--out", study_.out, "result directory (default: named after the study, beside its file)");
}

void CommandLine::forms(CLI::App* command, bool csv) {
  auto* json = command->add_flag("--json", json_, "print JSON");
  if (csv) command->add_flag("--csv", csv_, "print CSV")->excludes(json);
}

void CommandLine::study_commands() {
  auto* make = add("new", "write a commented study file to start from", "bedload new shields",
                   [this] { return new_command(name_); });
  make->add_option("NAME", name_, "of the study; NAME.toml is written")->required();

  auto* plan = add("plan", "show cases, models and why, steps, cost; run nothing", "bedload plan shields.toml",
                   [this] { return plan_command(study_); });
  study_argument(plan);
  forms(plan);
  plan->add_flag_callback("--probe", [] { not_in_this_version("plan --probe"); })->group("");

  auto* run = add("run", "start or resume; running it again is always safe", "bedload run shields.toml --cores 4",
                  [this] { return run_command(run_); });
  study_argument(run);
  run->add_option("--cores", run_.cores, "workers side by side (default: the study file's)")->check(check_workers);
  run->add_option("--only", study_.cases, "these cases: id prefixes, labels, globs of labels");
  run->add_flag("--prepare", run_.prepare, "make the case directories and stop");
  run->add_flag("--rescan", run_.rescan, "rebuild the database from the case directories first");
  run->add_flag("--recompute", run_.recompute, "start anew what another physics_version computed");
  run->add_flag("--replace", run_.replace, "go on although every case so far leaves the study");

  auto* trade = add("trade", "speed against accuracy, measured: what each [[trade]] costs and changes",
                    "bedload trade trade-laminar.toml --budget 3", [this] { return trade_command(run_, budget_); });
  study_argument(trade);
  trade->add_option("--cores", run_.cores, "workers side by side (default: the study file's)")->check(check_workers);
  trade->add_option("--budget", budget_, "core-hours: settings that plan predicts beyond are left out")
      ->check(CLI::PositiveNumber);
  forms(trade, false);

  auto* stop = add("stop", "let workers write a checkpoint and stop", "bedload stop shields.toml 'd0.5mm-*'",
                   [this] { return stop_command(study_); });
  study_argument(stop);
  stop->add_option("CASE", study_.cases, "cases (default: all)");

  auto* retry = add("retry", "failed cases become pending again", "bedload retry shields.toml",
                    [this] { return retry_command(study_); });
  study_argument(retry);
  retry->add_option("CASE", study_.cases, "cases (default: all that failed)");
}

void CommandLine::result_commands() {
  auto* status = add("status", "where every case stands", "bedload status shields.toml --watch",
                     [this] { return status_command(study_, watch_); });
  study_argument(status);
  forms(status);
  status->add_flag("--watch", watch_, "again every two seconds, until Ctrl-C");

  auto* explain = add("explain", "why a case is (not) running, was (not) reused, failed; its models and why",
                      "bedload explain shields.toml d0.5mm-rho2000-s1", [this] { return explain_command(study_); });
  study_argument(explain);
  forms(explain, false);
  explain->add_option("CASE", study_.cases, "id prefix, label, or glob of labels (default: the only case)");

  auto* curve = add("curve", "the threshold curve beside published ones",
                    "bedload curve shields.toml --csv > curve.csv", [this] { return curve_command(study_); });
  study_argument(curve);
  forms(curve);
  curve
      ->add_flag(
          "--svg", svg_,
          "print the figure of the report; of one grain in one liquid looked at in several ways, them side by side")
      ->excludes("--csv", "--json");

  auto* query = add("query", "any question to the result database, read only",
                    "bedload query shields.toml \"SELECT label, shields FROM threshold_curve\"",
                    [this] { return query_command(study_, sql_); });
  study_argument(query);
  query->add_option("SQL", sql_, "one SELECT")->required();
  forms(query);

  auto* report = add("report", "write report.html, one self-contained page", "bedload report shields.toml",
                     [this] { return report_command(study_); });
  study_argument(report);

  auto* view = add("view", "files that ParaView opens; prints the command",
                   "bedload view shields.toml d0.5mm-rho2000-s1", [this] { return view_command(study_, viewed_); });
  study_argument(view);
  view->add_option("CASE", viewed_,
                   "label or id prefix of one case; CASE@STEP: that checkpoint alone; CASE@bed, CASE@sheared, "
                   "CASE@onset: the bed settled, after its shear, at onset")
      ->required();
}

void CommandLine::validate_commands() {
  auto* validate = add("validate", "the validation ladder: reference, ours, band, pass or not",
                       "bedload validate contact settling --quick", [this] {
                         validate_.form = study_.form;
                         return validate_command(validate_);
                       });
  validate->add_option("GROUP", validate_.groups,
                       "contact, settling, bed, fluid, onset (default: all of these), or extremes");
  validate->add_flag("--quick,--short", validate_.quick, "a part of them: at most 3 minutes on 2 cores");
  validate->add_flag("--list", validate_.list, "which studies there are; run nothing");
  validate->add_option("--cores", validate_.cores, "cases side by side (default: all cores)")->check(check_workers);
  validate->add_option("--write", validate_.write,
                       "write verification.md and its figures (extremes: extremes.md) into this folder; not with "
                       "other groups. Links to study files hold in docs/ of the sources");
  forms(validate);
  validate->footer(
      "A band with % is of the reference, one without is in the unit of the row; a single number is allowed above and\n"
      "below, \"at most +0 %\" is a bound: any value up to the reference passes. Notes decide nothing.\n\n" +
      validate->get_footer());
}

void CommandLine::case_commands() {
  auto* inspect =
      add("inspect", "what is in a checkpoint", "bedload inspect shields/cases/0123456789ab/ck-1200.h5 --digest",
          [this] { return inspect_command(checkpoint_, digest_, verify_, study_.form); });
  inspect->add_option("CHECKPOINT", checkpoint_, "checkpoint file, or case directory for its newest")->required();
  inspect->add_flag("--digest", digest_, "only the digest of the state");
  inspect->add_flag("--verify", verify_, "only check that the file is whole");
  forms(inspect);

  auto* one = add("case", "run one case directory (what `run` starts; usable by hand)",
                  "bedload case shields/by-label/d0.5mm-rho2000-s1 --until \"0.2 s\"",
                  [this] { return case_command(directory_, until_); });
  one->add_option("DIR", directory_, "case directory")->required();
  one->add_option("--until", until_, "stop at this model time of the ramp, with a checkpoint");
}

void CommandLine::later_commands() {
  for (const char* name : {"prune", "doctor"}) {
    auto* command = app.add_subcommand(name, "not in this version")->group("");
    command->allow_extras();
    command->callback([name] { not_in_this_version(name); });
  }
}

CommandLine::CommandLine() {
  app.require_subcommand(1);
  app.set_version_flag("--version", version_text());
  app.add_flag("-q,--quiet", quiet_, "no progress and notes on stderr");
  app.add_flag("-v,--verbose", verbose_, "more of them");
  study_commands();
  result_commands();
  validate_commands();
  case_commands();
  later_commands();
}

/// What CLI11 refused, in the words of all other errors.
Error usage_error(const CLI::App& app, const CLI::ParseError& refused, int argc, char** argv) {
  if (const auto named = app.get_subcommands(); !named.empty())
    return {ErrorKind::usage, refused.what(),
            fmt::format("`bedload {} --help` shows what it takes", named[0]->get_name())};
  std::string commands;
  for (const auto* one : app.get_subcommands([](const CLI::App*) { return true; }))
    if (!one->get_group().empty()) commands += (commands.empty() ? "" : "|") + one->get_name();
  const auto* word = std::find_if(argv + 1, argv + argc, [](const char* a) { return a[0] != '-'; });
  if (word == argv + argc) return {ErrorKind::usage, refused.what(), "`bedload --help` lists the commands"};
  const auto nearest = nearest_word(*word, commands);
  return {ErrorKind::usage, fmt::format("`bedload {}` is not a command", *word),
          nearest.empty() ? "`bedload --help` lists the commands" : fmt::format("did you mean `bedload {}`?", nearest)};
}

int run(int argc, char** argv) {
  CommandLine line;
  try {
    line.app.parse(argc, argv);
    return line.code;
  } catch (const CLI::ParseError& e) {
    if (e.get_exit_code() == 0) return line.app.exit(e);   // --help, --version
    const auto error = usage_error(line.app, e, argc, argv);
    log_error(error);
    return error.exit_code();
  } catch (const Error& e) {
    log_error(e);
    return e.exit_code();
  }
}

}   // namespace

}   // namespace bedload

int main(int argc, char** argv) {
  try {
    return bedload::run(argc, argv);
  } catch (const std::exception& e) {
    bedload::log_error({bedload::ErrorKind::internal, e.what(), "this is a fault of bedload; please report it"});
    return static_cast<int>(bedload::ErrorKind::internal);
  }
}
