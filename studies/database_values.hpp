// Values of the database as numbers and text: what is NULL there is nan or empty here.
#pragma once

#include <cmath>
#include <cstdint>
#include <limits>
#include <string>

#include "scheduler/database.hpp"

namespace bedload {

inline Value real_or_null(double number) { return std::isfinite(number) ? Value(number) : Value(); }

inline double number_in(const Value& value) {
  if (const auto* real = std::get_if<double>(&value)) return *real;
  if (const auto* integer = std::get_if<std::int64_t>(&value)) return static_cast<double>(*integer);
  return std::numeric_limits<double>::quiet_NaN();
}

inline std::string text_in(const Value& value) {
  const auto* text = std::get_if<std::string>(&value);
  return text ? *text : std::string();
}

inline bool has_table(const Database& database, const std::string& name) {
  return !database.query("SELECT 1 FROM sqlite_schema WHERE name = ?", {name}).rows.empty();
}

/// A condition on column `case_id`: the case is in the study (every case, where no ledger is kept).
inline std::string in_study(const Database& database) {
  return has_table(database, "cases") ? "case_id IN (SELECT case_id FROM cases WHERE in_study)" : "1";
}

}   // namespace bedload
