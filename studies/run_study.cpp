// Plan, make directories, enrol, hand over to the scheduler.
#include "studies/run_study.hpp"

#include <algorithm>
#include <chrono>
#include <thread>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "base/build_info.hpp"
#include "base/counted.hpp"
#include "base/durable_file.hpp"
#include "base/error.hpp"
#include "base/log.hpp"
#include "checkpoint/checkpoint_series.hpp"
#include "scheduler/bed_sharing.hpp"
#include "scheduler/interrupts.hpp"
#include "scheduler/process_executor.hpp"
#include "scheduler/scheduler.hpp"
#include "solver/experiment.hpp"
#include "solver/required_models.hpp"
#include "studies/accuracy.hpp"
#include "studies/case_entry.hpp"
#include "studies/case_file.hpp"
#include "studies/case_identity.hpp"
#include "studies/case_warnings.hpp"
#include "studies/error_budget.hpp"
#include "studies/plan.hpp"
#include "studies/results.hpp"
#include "studies/study_file.hpp"
#include "studies/threshold_curve.hpp"

namespace bedload {

namespace fs = std::filesystem;

namespace {

std::optional<State> newest_state(const fs::path& directory) {
  return CheckpointSeries(directory, 2, [](const std::string& line) { log_warning(line); }).newest();
}

/// Who computed the final state: the last attempt, as far as it said.
Provenance provenance_of(const fs::path& directory) {
  const auto build = build_info();
  Provenance made{fmt::format("{} {}", build.version, build.commit), std::string(build.compiler),
                  std::string(build.flags), std::string(build.libraries), host_name()};
  if (const auto attempts = read_attempts(directory); !attempts.empty()) {
    made.version = attempts.back().version, made.compiler = attempts.back().compiler, made.host = attempts.back().host;
  }
  return made;
}

void store_results_of(Database& database, const fs::path& directory) {
  const auto one = read_case_directory(directory);
  const auto state = newest_state(directory);
  if (!state) throw Error(ErrorKind::corrupt, fmt::format("{} has no whole checkpoint", directory.string()));
  store_results(database, identity_of(one), one.scene, *state, provenance_of(directory));
}

/// How a case that failed went, up to its last checkpoint.
void store_health_of(Database& database, const fs::path& directory) {
  if (const auto state = newest_state(directory))
    store_health(database, identity_of(read_case_directory(directory)).id, *state);
}

Position position_of(const fs::path& directory) {
  const auto newest = newest_position(directory);
  const bool is_bed = directory.parent_path().filename() == "beds";
  return {newest ? newest->step : 0, is_bed ? has_bed(directory) : newest && newest->finished};
}

/// A finished case that is to go on gets a checkpoint that says so, before its case.toml changes: whatever is killed in
/// between, the next run sees the same plan again.
void reopen(const fs::path& directory, const Scene& scene) {
  const auto lock = FileLock::lock_or_refuse(directory / "lock", fmt::format("case {}", directory.string()));
  auto state = newest_state(directory);
  if (state && Experiment(scene).reopen(*state))
    CheckpointSeries(directory, 2, [](const std::string&) {}).publish(*state);
}

bool is_beside(const fs::path& named) {
  return named.is_relative() && std::ranges::find(named, fs::path("..")) == named.end();
}

void copy_beside(const fs::path& named, const std::string& bytes, const fs::path& results) {
  if (fs::exists(results / named) && read_text(results / named) == bytes) return;
  make_writable_directory((results / named).parent_path());
  publish(results / named, bytes);
}

/// The result directory is a study too: a table of grains that the copied study file names stands where it names it.
void copy_table(const CaseInputs& inputs, const fs::path& results) {
  const fs::path named = inputs.word("bed.file");
  if (is_beside(named)) copy_beside(named, inputs.csv, results);
}

/// So does the trade that it names.
void copy_trade(const Study& study, const fs::path& results) {
  const auto named = study.settings.find("models.accuracy.from");
  if (named == study.settings.end()) return;
  const fs::path file = named->second.text;
  if (is_beside(file)) copy_beside(file, read_text(study.file.parent_path() / file), results);
}

/// One run of one study.
class StudyRun {
 public:
  explicit StudyRun(const RunStudyRequest& request)
      : request_(request),
        study_(read_study(request.place.file)),
        directory_(request.place.directory),
        cases_(unfold(study_)) {}

  int run();

 private:
  void refuse_to_abandon(const Plan&) const;
  void make_directories(const Plan&);
  void copy_study_file() const;
  void enrol(Ledger&, const Plan&) const;
  void say_warnings() const;
  static void enlist(Database&, const fs::path& directory, std::vector<CaseEntry>&);
  void rescan(Ledger&);
  std::vector<std::string> chosen() const;
  int schedule(Ledger&);
  Scheduler scheduler(Ledger&, Executor&, SchedulerOptions) const;
  SchedulerWorld world() const;

  const RunStudyRequest& request_;
  Study study_;
  fs::path directory_;
  std::vector<Case> cases_;
};

SchedulerWorld StudyRun::world() const {
  const auto seconds = [] {
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
  };
  return {.newest = position_of,
          .on_finished = store_results_of,
          .on_failed = store_health_of,
          .spares = [this](const Database& database) { return spare_seeds(database, cases_, study_.seeds); },
          .clock = seconds,
          .interrupts = InterruptCounter::count};
}

/// Results that would fall out of the study are worth a question.
void StudyRun::refuse_to_abandon(const Plan& plan) const {
  if (!plan.other_physics.empty() && !request_.recompute) {
    throw Error(
        ErrorKind::study_invalid,
        fmt::format("{} of {} computed under another physics_version than this bedload's {} cannot go on",
                    counted(plan.other_physics.size(), "case"), directory_.string(), physics_version),
        "--recompute starts them anew (the old results stay in the database, marked); or use the bedload that computed "
        "them");
  }
  const auto is_new = [](const PlannedCase& c) { return c.fate == Fate::fresh; };
  const bool all_dropped = !plan.dropped.empty() && std::ranges::all_of(plan.cases, is_new);
  if (!all_dropped || request_.replace || request_.recompute) return;
  throw Error(
      ErrorKind::study_invalid,
      fmt::format("no case of {} is in the study file any more: all {} would be dropped", directory_.string(),
                  plan.dropped.size()),
      "--replace does that (their results stay, marked as out of the study); a new name in the study file keeps both");
}

void StudyRun::copy_study_file() const {
  const auto copy = directory_ / "study.toml";
  if (fs::exists(copy) && read_text(copy) == study_.text) return;
  publish(copy, study_.text);
}

void StudyRun::make_directories(const Plan& plan) {
  for (const auto& c : plan.cases)
    if (c.fate == Fate::extended) reopen(case_directory(directory_, c.one.id), c.one.scene);
  for (const auto& bed : plan.beds) {
    const auto id = case_id(bed);
    write_case_directory(bed_directory(directory_, id), bed, "bed-" + short_id(id), study_.run);
  }
  for (const auto& c : plan.cases) {
    const auto directory = case_directory(directory_, c.one.id);
    // A worker that outlived its scheduler ends by the case.toml it read; left as it is, the next run sees the difference.
    if (FileLock::holder(directory / "lock")) continue;
    write_case_directory(directory, c.one.inputs, c.one.label, study_.run);
    if (c.one.inputs.has("bed.file")) copy_table(c.one.inputs, directory_);
  }
  link_labels(directory_, cases_);
}

void StudyRun::enrol(Ledger& ledger, const Plan& plan) const {
  Database::Transaction transaction(ledger.database());
  std::vector<CaseEntry> entries;
  for (const auto& bed : plan.beds) entries.push_back(bed_entry(bed));
  for (const auto& c : plan.cases) entries.push_back(case_entry(c.one));
  ledger.enrol(entries);
  for (const auto& c : plan.cases) store_models(ledger.database(), c.one.id, c.one.scene);
  store_variations(ledger.database(), cases_);
  for (const auto& c : plan.cases)
    if (c.results_change) ledger.set_state(c.one.id, CaseState::pending);   // harvested again
  update_threshold_curve(ledger.database());
  transaction.commit();
}

/// Before anything runs: numbers come out also where the models do not hold.
void StudyRun::say_warnings() const {
  std::vector<CaseWarning> all;
  for (const auto& one : cases_)
    for (auto& text : warnings_of(one.scene)) all.push_back({one.label, std::move(text)});
  for (const auto& warning : shared_warnings(all))
    log_warning(fmt::format("{}: {}", cases_in_words(warning), warning.text));
}

/// The id of a case computed under another physics_version cannot be told from here.
void StudyRun::enlist(Database& database, const fs::path& directory, std::vector<CaseEntry>& entries) {
  const auto one = read_case_directory(directory);
  auto entry = entry_of(one);
  if (directory.filename() != short_id(entry.id))
    return log_warning(fmt::format("{} was made under another physics_version: left out", directory.string()));
  if (!entry.is_bed) store_models(database, entry.id, one.scene);
  entries.push_back(std::move(entry));
}

/// Every case that has a directory, also those that left the study file, with its results.
void StudyRun::rescan(Ledger& ledger) {
  std::vector<CaseEntry> entries;
  for (const auto* kind : {"beds", "cases"}) {
    if (!fs::exists(directory_ / kind)) continue;
    for (const auto& found : fs::directory_iterator(directory_ / kind))
      if (fs::exists(found.path() / "case.toml")) enlist(ledger.database(), found.path(), entries);
  }
  std::ranges::sort(entries, {}, [](const CaseEntry& e) { return std::pair(!e.is_bed, e.label); });
  ledger.enrol(entries);
  ProcessExecutor executor({});
  scheduler(ledger, executor, {}).reconcile();
}

std::vector<std::string> StudyRun::chosen() const {
  std::vector<CaseEntry> entries;
  for (const auto& one : cases_) entries.push_back(case_entry(one));
  std::vector<std::string> ids;
  for (const auto& word : request_.only)
    for (const auto& entry : matching_cases(entries, word)) ids.push_back(entry.id);
  return ids;
}

Scheduler StudyRun::scheduler(Ledger& ledger, Executor& executor, SchedulerOptions options) const {
  return Scheduler(ledger, executor, *request_.sink, world(), std::move(options));
}

int StudyRun::schedule(Ledger& ledger) {
  const int all_cores = static_cast<int>(std::max(1u, std::thread::hardware_concurrency()));
  const int asked = request_.cores.value_or(study_.run.cores);
  const InterruptCounter interrupts;
  ProcessExecutor executor({fs::read_symlink("/proc/self/exe").string(), "case"});
  auto work =
      scheduler(ledger, executor,
                {.cores = asked > 0 ? asked : all_cores, .only = chosen(), .stall_limit = study_.run.stall_limit});
  const auto outcome = work.run();
  log_note(
      fmt::format("{}: {} done, {} failed, {} left", directory_.string(), outcome.done, outcome.failed, outcome.left));
  return outcome.exit_code;
}

/// A directory of that name that holds something else is left alone.
void refuse_foreign_directory(const fs::path& directory) {
  if (!fs::is_directory(directory) || fs::is_empty(directory)) return;
  for (const auto* sign : {"lock", "study.db", "study.toml"})
    if (fs::exists(directory / sign)) return;
  throw Error(ErrorKind::study_invalid,
              fmt::format("{} exists and is no result directory of bedload", directory.string()),
              "another name in the study file, or --out");
}

int StudyRun::run() {
  refuse_foreign_directory(directory_);
  chosen();   // a misspelt --only is found before anything is written
  make_writable_directory(directory_);
  const auto lock = lock_study(directory_);
  const auto file = database_file(directory_);
  if (request_.rescan)
    for (const char* end : {"", "-wal", "-shm"}) fs::remove(file.string() + end);
  Database database(file, Database::Mode::write);
  Ledger ledger(database, directory_);
  create_result_tables(database);
  if (request_.rescan) rescan(ledger);
  const auto plan = make_plan(cases_, read_cases(database), directory_);
  refuse_to_abandon(plan);
  say_warnings();
  Problems none(study_.file.string());   // told by unfold
  if (const auto chosen = chosen_accuracy(study_, read_text, none)) log_note(chosen->in_words());
  copy_study_file();
  copy_trade(study_, directory_);
  enrol(ledger, plan);
  make_directories(plan);
  if (!request_.prepare) return schedule(ledger);
  log_note(fmt::format("{} prepared in {}; nothing was started", counted(cases_.size(), "case"),
                       (directory_ / "cases").string()));
  return 0;
}

}   // namespace

int run_study(const RunStudyRequest& request) { return StudyRun(request).run(); }

}   // namespace bedload
