#include "studies/accuracy.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "base/error.hpp"
#include "solver/dimensionless.hpp"
#include "solver/scene_numbers.hpp"
#include "solver/state.hpp"
#include "studies/setting_text.hpp"
#include "studies/study_file.hpp"
#include "studies/trade.hpp"

namespace bedload {

namespace {

using nlohmann::json;

constexpr double farthest = 3;   // factor by which a scene may differ from the one of its trade

/// Of a way to compute, not of a scene: what may be chosen for another one.
bool is_numerical(const std::string& key) {
  return key.starts_with("box.cell.") || key.starts_with("models.") || key.starts_with("steps.") ||
         key == "onset.hold" || key == "onset.bracket" || key == "drive.dwell" || key == "grains.stiffness";
}

/// The keys and values of a trade's setting that another study may take over, read as a study file would be.
Settings settings_in(const json& values, const std::string& file) {
  std::string text = "format = 1\n";
  for (const auto& [key, value] : values.items())
    if (is_numerical(key)) text += key + " = " + value.get<std::string>() + "\n";
  return parse_study(text, file).settings;
}

/// The error to reckon with; none where it is not known, or a packing has no theta_c, or the setting is another scene.
std::optional<double> error_of(const json& setting, std::size_t packings) {
  const auto &theta = setting.at("theta"), &low = theta.at("low"), &high = theta.at("high");
  if (setting.at("thresholds").get<std::size_t>() < packings || !low.is_number() || !high.is_number()) return {};
  for (const auto& [key, value] : setting.at("changes").items())
    if (!is_numerical(key)) return {};
  return std::max(std::abs(low.get<double>()), std::abs(high.get<double>()));
}

/// Which rungs of the fluid may be chosen for a study: the one that it names itself; else the box, and a column where one velocity at each
/// height can be the mean of the flow and the box has been its measure; an imposed profile never.
class RungRule {
 public:
  RungRule(const Study& study, const json& finest) : of_finest_(rung_in(finest, "box")) {
    const auto own = study.settings.find("models.fluid");
    if (own != study.settings.end() && own->second.text != "auto") own_ = own->second.text;
    for (const auto& [key, setting] : study.settings) judge(key, setting);
    for (const auto& axis : study.axes)
      for (const auto& setting : axis.values) judge(axis.key, setting);
  }

  bool names_its_own() const { return !own_.empty(); }
  std::string rung_of(const json& setting) const { return rung_in(setting.at("changes"), of_finest_); }
  /// Why a rung may not be chosen; empty if it may.
  std::string objection(const std::string& rung) const {
    if (!own_.empty()) return rung == own_ ? "" : fmt::format("the study asks for models.fluid = \"{}\"", own_);
    if (rung == "box") return {};
    if (rung == "profile") return "an imposed profile does not answer to grains";
    if (of_finest_ != "box") return "nothing measures it against a box";
    return not_uniform_;
  }

 private:
  static std::string rung_in(const json& values, const std::string& otherwise) {
    if (!values.contains("models.fluid")) return otherwise;
    const auto toml = values.at("models.fluid").get<std::string>();
    for (const char* rung : {"column", "profile"})
      if (toml == fmt::format("\"{}\"", rung)) return rung;
    return "box";
  }
  void judge(const std::string& key, const Setting& setting) {
    if ((key == "box.x" || key == "box.y") && std::get<std::string>(setting.value) == "wall")
      not_uniform_ = fmt::format("{} = \"wall\" makes the flow differ across", key);
    if (key == "box.slope" && std::get<Quantity>(setting.value).value != 0)
      not_uniform_ = fmt::format("box.slope = {}, and a column is taken for level beds alone", setting.text);
  }

  std::string of_finest_, own_, not_uniform_;
};

struct Chosen {
  const json* setting;       // null: none
  std::string passed_over;   // a cheaper one that is good enough, and why it is not taken
};

Chosen cheapest(const json& settings, double target, const RungRule& rule) {
  const json *best = nullptr, *refused = nullptr;
  const auto packings = settings.at(0).at("packings").get<std::size_t>();
  for (const auto& one : settings) {
    const auto error = &one == &settings.at(0) ? std::optional(0.0) : error_of(one, packings);   // the measure itself
    if (!error || *error > target) continue;
    const json*& among = rule.objection(rule.rung_of(one)).empty() ? best : refused;
    if (!among || one.at("core_seconds") < among->at("core_seconds")) among = &one;
  }
  if (!best || !refused || refused->at("core_seconds") >= best->at("core_seconds")) return {best, {}};
  const auto rung = rule.rung_of(*refused);
  return {best, fmt::format("{} (models.fluid = {}) costs less and is passed over: {}",
                            refused->at("name").get<std::string>(), rung, rule.objection(rung))};
}

AccuracyChoice choice_from(const Study& study, const json& trade, const std::string& file, double target) {
  const json &settings = trade.at("settings"), &scene = trade.at("scene");
  const RungRule rule(study, trade.at("finest"));
  const auto of_finest = rule.rung_of(settings.at(0));
  const auto [found, passed_over] = cheapest(settings, target, rule);
  if (!found)
    throw Error(
        ErrorKind::study_invalid,
        fmt::format("no setting of {} is known to be within {:.3g} %; its finest is a {}: {}", file, 100 * target,
                    of_finest, rule.objection(of_finest)),
        fmt::format("models.fluid = \"{}\", or a trade whose finest setting is what this study asks for", of_finest));
  const json& chosen = *found;
  AccuracyChoice made;
  made.fluid = rule.rung_of(chosen), made.passed_over = passed_over;
  made.from = file, made.target = target, made.setting = chosen.at("name");
  made.settings = settings_in(trade.at("finest"), file);
  for (auto& [key, setting] : settings_in(chosen.at("changes"), file)) made.settings[key] = setting;
  made.finest = found == &settings.at(0);
  made.error = made.finest ? 0 : *error_of(chosen, 0);
  made.fluid_is_named = rule.names_its_own();
  const double seconds = chosen.at("core_seconds");
  made.cost = seconds / settings.at(0).at("core_seconds").get<double>();
  made.pace = seconds / chosen.at("predicted_seconds").get<double>();
  made.galileo = scene.at("galileo"), made.density_ratio = scene.at("density_ratio"),
  made.shields = scene.at("shields"), made.diameter = scene.at("diameter_m"),
  made.grain_time = scene.at("grain_time_s"), made.version = trade.at("physics_version");
  return made;
}

bool far(double a, double b) { return !(a <= farthest * b && b <= farthest * a); }

}   // namespace

std::string AccuracyChoice::in_words() const {
  std::string list;
  for (const auto& [key, value] : settings)
    list += fmt::format("{}{} = {}", list.empty() ? "" : ", ", key, as_toml(value));
  const auto rung =
      fluid == "column" && !fluid_is_named ? "; a column, as x and y are periodic and the bed is level" : "";
  const auto how = finest ? fmt::format("nothing cheaper in {} is known to be so near; its finest setting", from)
                          : fmt::format(
                                "setting {} of {}, theta_c measured to be within {:.2g} % of the finest, for "
                                "{:.2g} of its time",
                                setting, from, 100 * error, cost);
  const auto of_old = version == physics_version ? ""
                                                 : fmt::format(
                                                       ". It was measured under physics_version {}; this bedload's "
                                                       "is {}",
                                                       version, physics_version);
  return fmt::format("accuracy {:.3g} %: {}{}: {}{}{}", 100 * target, how, rung, list,
                     passed_over.empty() ? "" : ". " + passed_over, of_old);
}

std::optional<AccuracyChoice> chosen_accuracy(const Study& study, const TableReader& read_table, Problems& problems) {
  const auto target = study.settings.find("models.accuracy.target"), from = study.settings.find("models.accuracy.from");
  if (target == study.settings.end() && from == study.settings.end()) return {};
  if (target == study.settings.end() || from == study.settings.end()) {
    const auto& there = target == study.settings.end() ? from->second : target->second;
    problems.add(there.place, "models.accuracy: a target and the trade that measured it are needed",
                 "accuracy = { target = \"5 %\", from = \"trade-laminar/trade.json\" }");
    return {};
  }
  const auto file = study.file.parent_path() / from->second.text;
  try {
    const auto trade = json::parse(read_table(file));
    if (const int format = trade.at("format"); format != trade_format)
      throw Error(ErrorKind::study_invalid,
                  fmt::format("{} has format {}; this bedload reads {}", file.string(), format, trade_format),
                  "bedload trade writes it anew from what has run");
    return choice_from(study, trade, from->second.text, std::get<Quantity>(target->second.value).value);
  } catch (const json::exception& error) {
    problems.add(from->second.place,
                 fmt::format("models.accuracy.from: {} is not a trade: {}", file.string(), error.what()),
                 "the trade.json that `bedload trade` writes");
  } catch (const Error& error) {
    problems.add(from->second.place, fmt::format("models.accuracy.from: {}", error.what()), error.hint);
  }
  return {};
}

std::string too_far(const AccuracyChoice& choice, const Scene& scene) {
  const auto& bed = scene.bed;
  const double s = bed.grains.density / bed.fluid.density;
  const double galileo = galileo_number(s, norm(bed.gravity), bed.grains.diameter, bed.fluid.viscosity);
  const auto& levels = scene.drive.levels;
  const auto said = [&](std::string_view what, double here) {
    return fmt::format("{} {:.3g} is more than a factor {:g} from the trade's", what, here, farthest);
  };
  if (far(galileo, choice.galileo)) return said("the Galileo number", galileo) + fmt::format(" {:.3g}", choice.galileo);
  if (far(s, choice.density_ratio)) return said("the density ratio", s) + fmt::format(" {:.3g}", choice.density_ratio);
  if (levels.empty()) return {};
  if (scene.drive.quantity != FlowRamp::Quantity::shields)
    return "the drive gives no Shields numbers, which would have to be near the trade's";
  const auto is_far = [&](double level) { return far(level, choice.shields); };
  const auto astray = std::ranges::find_if(levels, is_far);
  const bool seeks = scene.onset.method != Onset::Method::none;   // then some level must be near, else all
  if (seeks ? std::ranges::all_of(levels, is_far) : astray != levels.end())
    return said(seeks ? "every Shields number, the first being" : "the Shields number", *astray) +
           fmt::format(" {:.3g}", choice.shields);
  return {};
}

std::string of_another_scale(const AccuracyChoice& choice, const Scene& scene) {
  const auto differs = [](double a, double b) { return std::abs(a / b - 1) > 0.01; };
  const bool other =
      differs(scene.bed.grains.diameter, choice.diameter) || differs(numbers_of(scene).grain_time, choice.grain_time);
  if (!other) return {};
  for (const auto& [key, setting] : choice.settings) {
    const auto* value = std::get_if<Quantity>(&setting.value);
    if (value && value->value != 0 && !value->relative())
      return fmt::format("{} = {} is a value for grains of {:.4g} mm and a grain time of {:.3g} s", key, setting.text,
                         1e3 * choice.diameter, choice.grain_time);
  }
  return {};
}

}   // namespace bedload
