// Layout of VTKHDF: https://docs.vtk.org/en/latest/vtk_file_formats/vtkhdf_file_format/index.html, version 1.0, which VTK 9.1 reads.
#include "studies/vtk_files.hpp"

#include <fmt/format.h>

#include <array>
#include <cstdint>
#include <numeric>
#include <span>

#include "checkpoint/hdf5_file.hpp"
#include "solver/bed/frozen_grains.hpp"
#include "solver/coupling/void_fraction.hpp"
#include "solver/fluid/boundaries.hpp"

namespace bedload {

namespace {

using Whole = std::int64_t;   // vtkCellArray takes no unsigned ones

void begin(Hdf5Writer& file, const std::string& type) {
  const std::array<Whole, 2> version{1, 0};
  file.write_attribute("VTKHDF", "Version", std::span<const Whole>(version));
  file.write_attribute("VTKHDF", "Type", type);
}

template <class Number>
void write_row(Hdf5Writer& file, const std::string& name, const std::vector<Number>& row, const std::string& unit) {
  file.write("VTKHDF/" + name, std::span<const Number>(row), Shape{row.size()}, unit);
}

void write_vectors(Hdf5Writer& file, const std::string& name, const std::vector<Vec3>& rows, const std::string& unit) {
  file.write("VTKHDF/" + name, std::span<const double>(reinterpret_cast<const double*>(rows.data()), 3 * rows.size()),
             Shape{rows.size(), 3}, unit);
}

/// visit(padded index) for all cells, x fastest as VTK has it.
template <class Visit>
void for_each_cell_of_vtk(const StaggeredGrid& grid, Visit&& visit) {
  for (int k = 0; k < grid.cells[2]; ++k)
    for (int j = 0; j < grid.cells[1]; ++j)
      for (int i = 0; i < grid.cells[0]; ++i) visit(grid.index(i, j, k));
}

std::vector<double> velocity_at_centres(const StaggeredGrid& grid, const FaceFields& on_faces) {
  std::vector<double> row;
  for_each_cell_of_vtk(grid, [&](std::size_t n) {
    for (int c = 0; c < 3; ++c) {
      const double* u = on_faces.component(c);
      row.push_back(0.5 * (u[n] + u[n + std::size_t(grid.stride(c))]));
    }
  });
  return row;
}

std::vector<double> at_centres(const StaggeredGrid& grid, const Field<Centre>& field, double factor) {
  std::vector<double> row;
  for_each_cell_of_vtk(grid, [&](std::size_t n) { row.push_back(factor * field[n]); });
  return row;
}

Field<Centre> void_fraction(const Scene& scene, const Grains& grains) {
  Stencils stencils;
  VoidFraction found(scene.grid);
  find_stencils(scene.grid, grains, stencils);
  deposit_void_fraction(scene.grid, grains, stencils, found, KernelSmoothing(scene.grid, scene.smoothing));
  return found.centre;
}

std::vector<Whole> contacts_of(const State& state) {
  const ContactHistory contacts = all_contacts(state.contacts, state.asleep);
  std::vector<Whole> touching(state.grains.size(), 0);
  for (std::size_t n = 0; n < contacts.size(); ++n) {
    ++touching[contacts.lower[n]];
    if (contacts.higher[n] < touching.size()) ++touching[contacts.higher[n]];   // else a wall
  }
  return touching;
}

std::vector<Whole> counting(std::size_t n) {
  std::vector<Whole> row(n);
  std::iota(row.begin(), row.end(), Whole(0));
  return row;
}

std::string array_in_xdmf(const std::string& shape, const std::string& type, const std::string& file,
                          const std::string& name) {
  return fmt::format("<DataItem Dimensions='{}' {} Format='HDF'>{}:/VTKHDF/{}</DataItem>", shape, type, file, name);
}

constexpr auto real = "NumberType='Float' Precision='8'", whole = "NumberType='Int' Precision='8'";

std::string attribute_in_xdmf(const std::string& name, bool vector, const char* type, const std::string& shape,
                              const std::string& file) {
  return fmt::format("      <Attribute Name='{}' AttributeType='{}' Center='Node'>{}</Attribute>\n", name,
                     vector ? "Vector" : "Scalar",
                     array_in_xdmf(vector ? shape + " 3" : shape, type, file, "PointData/" + name));
}

std::string fluid_in_xdmf(const Scene& scene, const ViewedMoment& at) {
  const auto& [nx, ny, nz] = scene.grid.cells;
  const auto h = scene.grid.h;
  const auto shape = fmt::format("{} {} {}", nz, ny, nx), file = fluid_file(at.name);
  return fmt::format(
             "    <Grid Name='fluid'>\n      <Time Value='{}'/>\n      <Topology TopologyType='3DCoRectMesh' "
             "Dimensions='{}'/>\n"
             "      <Geometry GeometryType='ORIGIN_DXDYDZ'><DataItem Dimensions='3' Format='XML'>{} {} {}</DataItem>"
             "<DataItem Dimensions='3' Format='XML'>{} {} {}</DataItem></Geometry>\n",
             at.time, shape, h.z / 2, h.y / 2, h.x / 2, h.z, h.y, h.x) +
         attribute_in_xdmf("velocity", true, real, shape, file) +
         attribute_in_xdmf("pressure", false, real, shape, file) +
         attribute_in_xdmf("void_fraction", false, real, shape, file) + "    </Grid>\n";
}

std::string grains_in_xdmf(const ViewedMoment& at) {
  const auto n = fmt::format("{}", at.grains), file = grains_file(at.name);
  return fmt::format(
             "    <Grid Name='grains'>\n      <Time Value='{}'/>\n      <Topology TopologyType='Polyvertex' "
             "NumberOfElements='{}'/>\n      <Geometry GeometryType='XYZ'>{}</Geometry>\n",
             at.time, n, array_in_xdmf(n + " 3", real, file, "Points")) +
         attribute_in_xdmf("diameter", false, real, n, file) + attribute_in_xdmf("velocity", true, real, n, file) +
         attribute_in_xdmf("spin", true, real, n, file) + attribute_in_xdmf("id", false, whole, n, file) +
         attribute_in_xdmf("contacts", false, whole, n, file) + "    </Grid>\n";
}

template <class Step>
std::string series_in_xdmf(const std::string& name, const std::vector<ViewedMoment>& steps, Step&& step) {
  std::string text = fmt::format("  <Grid Name='{}' GridType='Collection' CollectionType='Temporal'>\n", name);
  for (const auto& at : steps) text += step(at);
  return text + "  </Grid>\n";
}

}   // namespace

std::vector<std::byte> fluid_for_vtk(const Scene& scene, State state) {
  const StaggeredGrid& grid = scene.grid;
  fill_velocity_ghosts(grid, state.fluid.velocity, state.search.lid_speed);
  const auto [nx, ny, nz] = grid.cells;
  const std::array<Whole, 6> extent{0, Whole(nx - 1), 0, Whole(ny - 1), 0, Whole(nz - 1)};
  const std::array<double, 3> origin{grid.h.x / 2, grid.h.y / 2, grid.h.z / 2}, spacing{grid.h.x, grid.h.y, grid.h.z};
  const std::array<double, 9> direction{1, 0, 0, 0, 1, 0, 0, 0, 1};
  Hdf5Writer file;
  begin(file, "ImageData");
  file.write_attribute("VTKHDF", "WholeExtent", std::span<const Whole>(extent));
  file.write_attribute("VTKHDF", "Origin", std::span<const double>(origin));
  file.write_attribute("VTKHDF", "Spacing", std::span<const double>(spacing));
  file.write_attribute("VTKHDF", "Direction", std::span<const double>(direction));
  const auto write = [&](const std::string& name, const std::vector<double>& row, bool vector, const char* unit) {
    Shape shape{std::uint64_t(nz), std::uint64_t(ny), std::uint64_t(nx)};
    if (vector) shape.push_back(3);
    file.write("VTKHDF/PointData/" + name, std::span<const double>(row), shape, unit);
  };
  write("velocity", velocity_at_centres(grid, state.fluid.velocity), true, "m/s");
  write("pressure", at_centres(grid, state.fluid.pressure, scene.bed.fluid.density), false, "Pa");
  write("void_fraction", at_centres(grid, void_fraction(scene, state.grains), 1), false, "1");
  return file.image();
}

std::vector<std::byte> grains_for_vtk(const State& state) {
  const Grains& grains = state.grains;
  const std::size_t n = grains.size();
  const std::vector<Whole> count{Whole(n)};
  Hdf5Writer file;
  begin(file, "UnstructuredGrid");
  for (const char* name : {"NumberOfPoints", "NumberOfCells", "NumberOfConnectivityIds"})
    write_row(file, name, count, "1");
  write_vectors(file, "Points", grains.position, "m");
  write_row(file, "Connectivity", counting(n), "1");
  write_row(file, "Offsets", counting(n + 1), "1");
  write_row(file, "Types", std::vector<std::uint8_t>(n, 1), "1");   // VTK_VERTEX
  write_row(file, "PointData/id", counting(n), "1");
  write_row(file, "PointData/diameter", grains.diameter, "m");
  write_row(file, "PointData/density", grains.density, "kg/m3");
  write_vectors(file, "PointData/velocity", grains.velocity, "m/s");
  write_vectors(file, "PointData/spin", grains.spin, "rad/s");
  write_row(file, "PointData/fixed", grains.fixed, "1");
  write_row(file, "PointData/contacts", contacts_of(state), "1");
  write_vectors(file, "PointData/contact_force", grains.mean_contact_force, "N");
  return file.image();
}

std::string fluid_file(const std::string& moment) { return fmt::format("fluid-{}.hdf", moment); }
std::string grains_file(const std::string& moment) { return fmt::format("grains-{}.hdf", moment); }

std::string xdmf_index(const Scene& scene, const std::vector<ViewedMoment>& steps) {
  return "<?xml version='1.0'?>\n<Xdmf Version='3.0'><Domain>\n" +
         series_in_xdmf("fluid", steps, [&](const ViewedMoment& at) { return fluid_in_xdmf(scene, at); }) +
         series_in_xdmf("grains", steps, grains_in_xdmf) + "</Domain></Xdmf>\n";
}

}   // namespace bedload
