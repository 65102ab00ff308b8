// Writes the settled bed of the benchmarks for other codes: export_bed GRAINS DIRECTORY.
#include <fmt/format.h>
#include <fmt/os.h>

#include <charconv>
#include <filesystem>
#include <string_view>

#include "benchmarks/settled_bed.hpp"
#include "solver/grains/box_walls.hpp"

namespace bedload::benchmarks {
namespace {

/// bed.data: atoms of style sphere as LAMMPS and LIGGGHTS read them, in metres.
void write_atoms(const Bed& bed, const std::filesystem::path& file) {
  auto out = fmt::output_file(file.string());
  const Vec3 box = bed.scene.length;
  out.print("settled bed\n\n{} atoms\n1 atom types\n\n0 {} xlo xhi\n0 {} ylo yhi\n0 {} zlo zhi\n\nAtoms\n\n",
            bed.grains.size(), box.x, box.y, box.z);
  for (std::size_t i = 0; i < bed.grains.size(); ++i) {
    const Vec3 p = PeriodicBox(bed.scene).wrapped(bed.grains.position[i]);
    out.print("{} 1 {} {} {} {} {}\n", i + 1, bed.grains.diameter[i], bed.grains.density[i], p.x, p.y, p.z);
  }
}

/// parcels: sites of OpenFOAM's look-up table injection: place, velocity, diameter, density, mass rate.
void write_parcels(const Bed& bed, const std::filesystem::path& file) {
  auto out = fmt::output_file(file.string());
  out.print("FoamFile {{ version 2.0; format ascii; class dictionary; object parcels; }}\n(\n");
  for (std::size_t i = 0; i < bed.grains.size(); ++i) {
    const Vec3 p = PeriodicBox(bed.scene).wrapped(bed.grains.position[i]);
    out.print("({} {} {}) (0 0 0) {} {} 1\n", p.x, p.y, p.z, bed.grains.diameter[i], bed.grains.density[i]);
  }
  out.print(")\n");
}

}   // namespace
}   // namespace bedload::benchmarks

int main(int argc, char** argv) {
  using namespace bedload::benchmarks;
  std::size_t grains = 0;
  if (argc == 3) std::from_chars(argv[1], argv[1] + std::string_view(argv[1]).size(), grains);
  if (grains == 0) {
    fmt::print(stderr, "usage: export_bed GRAINS DIRECTORY\n");
    return 64;
  }
  const std::filesystem::path directory = argv[2];
  std::filesystem::create_directories(directory);
  const Bed& bed = settled_bed(grains);
  write_atoms(bed, directory / "bed.data");
  write_parcels(bed, directory / "parcels");
}
