// Four cases of 300 grains, a few seconds each.
#pragma once

#include <string>

namespace bedload {

inline const std::string tiny_study = R"(format = 1
name = "tiny"

[fluid]
density = "1000 kg/m3"
viscosity = "1.0e-5 m2/s"

[grains]
diameter = ["0.5 mm", "0.6 mm"]
density = ["2000 kg/m3", "3000 kg/m3"]

[bed]
count = 300

[box]
length = "10 d"
width = "6 d"
height = "12 d"
cell = { xy = "2 d", z = "1 d" }

[drive]
kind = "lid"
shields = { from = 0.1, ratio = 1.5, steps = 4 }
dwell = "5 td"

[run]
checkpoint.every = "1 s"
)";

inline std::string with(std::string text, const std::string& part, const std::string& instead) {
  return text.replace(text.find(part), part.size(), instead);
}

}   // namespace bedload
