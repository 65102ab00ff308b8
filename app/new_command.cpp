// `bedload new`: a commented study file to start from.
#include <fmt/format.h>

#include "app/commands.hpp"
#include "base/durable_file.hpp"
#include "base/error.hpp"
#include "studies/study_file.hpp"

namespace bedload {

namespace {

constexpr const char* study_template =
    R"(# A study of incipient sediment motion. Every list is an axis: the cases are the product of all axes.
# bedload plan {0}.toml    shows the cases, the models, the cost
# bedload run {0}.toml     starts or resumes; running it again is always safe
format = 1
name   = "{0}"                              # also the result directory, beside this file

[fluid]
density   = "1000 kg/m3"
viscosity = "1.0e-5 m2/s"                   # kinematic; ten times water's, so that the flow over the bed is laminar

[grains]
diameter    = ["0.5 mm", "0.6 mm"]          # mean
density     = ["2000 kg/m3", "3000 kg/m3"]
spread      = 0.05                          # standard deviation / mean, normal, cut at 2 deviations; 0 = equal spheres
friction    = 0.4
restitution = 0.6
poisson     = 0.3
stiffness   = "auto"                        # Young's modulus: as soft as the overlaps allow

[bed]
source = "poured"                           # poured | lattice | file | none
count  = 1500                               # or  depth = "6 d"
seed   = {{ count = 1 }}                      # packings: more of them give the spread of the threshold

[box]
length = "20 d"                             # x, along the flow; d = mean grain diameter
width  = "12 d"                             # y
height = "13 d"                             # z; the gap is what the bed leaves
cell   = {{ xy = "2 d", z = "0.5 d" }}        # theta_c depends on z
x = "periodic"                              # periodic | wall
y = "periodic"
gravity = "9.81 m/s2"

[drive]
kind    = "lid"                             # lid | pressure | push | through_flow | none
shields = {{ from = 0.06, ratio = 1.2, steps = 12 }}
dwell   = "25 td"                           # per step; td = max(sqrt(d/((s-1) g)), d/U_t)

[onset]
method    = "ramp"                          # ramp (screening) | bisect (holds from one settled bed) | none
criterion = "flux"                          # flux | moving_fraction
value     = 1e-2

[models]
drag  = "di_felice"                         # or gidaspow, beetstra, tang, koch_hill, rong, ergun, schiller_naumann, stokes
terms = "auto"                              # what the scene requires: `bedload plan` says which terms, and why; or a list,
                                            # such as ["drag", "buoyancy", "pressure_gradient", "viscous_stress"]
# strict = true                             # refuse a scene outside the range of its models

[steps]
dem   = "auto"                              # 0.2 Rayleigh times
fluid = "auto"                              # 10 DEM steps, cut by the stability limits

[record]
every = "1 td"

[run]                                       # how, not what: no part of a case's identity
cores      = "all"
checkpoint = {{ every = "5 min", keep = 2 }}
)";

}   // namespace

int new_command(const std::string& name) {
  const auto title = name.ends_with(".toml") ? name.substr(0, name.size() - 5) : name;
  if (!is_study_name(title))
    throw Error(ErrorKind::usage, fmt::format("\"{}\" cannot be the name of a study", name),
                "letters, digits, - and _; it is written into the current directory");
  const std::filesystem::path file = title + ".toml";
  if (!publish_once(file, fmt::format(fmt::runtime(study_template), title)))
    throw Error(ErrorKind::usage, fmt::format("{} exists already", file.string()), "choose another name");
  fmt::print("{}\n", file.string());
  return 0;
}

}   // namespace bedload
