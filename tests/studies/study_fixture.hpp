// A study that is right, to be made wrong in one place.
#pragma once

#include <gtest/gtest.h>

#include <string>

#include "base/error.hpp"
#include "studies/study_file.hpp"

namespace bedload {

inline const std::string good_study = R"(format = 1
name = "screening"

[fluid]
density = "1000 kg/m3"
viscosity = "1.0e-5 m2/s"

[grains]
diameter = ["0.5 mm", "0.6 mm"]
density = ["2000 kg/m3", "3000 kg/m3"]
spread = 0.05

[bed]
count = 300
seed = { count = 2 }

[box]
length = "10 d"
width = "6 d"
height = "13 d"

[drive]
kind = "lid"
shields = { from = 0.06, ratio = 1.2, steps = 12 }
dwell = "25 td"
)";

/// The text with one part replaced; the part must be there.
inline std::string with(std::string text, const std::string& part, const std::string& instead) {
  return text.replace(text.find(part), part.size(), instead);
}

/// What is said about a study that cannot be used; empty if nothing.
inline std::string complaint(const std::string& text) {
  try {
    unfold(parse_study(text, "study.toml"));
  } catch (const Error& error) {
    return error.what();
  }
  return {};
}

inline testing::AssertionResult says(const std::string& text, const std::string& part) {
  if (text.find(part) != std::string::npos) return testing::AssertionSuccess();
  return testing::AssertionFailure() << "\"" << part << "\" is not in: " << text;
}

}   // namespace bedload
