// `bedload view`: what VTK reads is what the checkpoint holds, to the last bit.
#include <gtest/gtest.h>

#include <cstring>

#include "base/durable_file.hpp"
#include "checkpoint/checkpoint.hpp"
#include "checkpoint/checkpoint_series.hpp"
#include "tests/end_to_end/bedload_program.hpp"
#include "tests/end_to_end/tiny_study.hpp"
#include "tests/support/temporary_directory.hpp"

namespace bedload {
namespace {

namespace fs = std::filesystem;

/// That moves in its only hold.
const std::string one_case = with(with(with(with(tiny_study, "[\"0.5 mm\", \"0.6 mm\"]", "\"0.5 mm\""),
                                            "[\"2000 kg/m3\", \"3000 kg/m3\"]", "\"3000 kg/m3\""),
                                       "count = 300", "count = 100"),
                                  "from = 0.1, ratio = 1.5, steps = 4", "from = 0.4, ratio = 1.5, steps = 1");

/// Dumps points and every array of a file as VTK's reader has them, raw, one file each.
constexpr auto dump = R"(
import sys
from vtkmodules.vtkIOHDF import vtkHDFReader
file, folder = sys.argv[1:]
reader = vtkHDFReader()
assert reader.CanReadFile(file)
reader.SetFileName(file)
reader.Update()
data = reader.GetOutput()
arrays = data.GetPointData()
for n in range(arrays.GetNumberOfArrays()):
    open(folder + '/' + arrays.GetArrayName(n), 'wb').write(bytes(memoryview(arrays.GetArray(n))))
if data.IsA('vtkUnstructuredGrid'):
    assert all(data.GetCellType(n) == 1 for n in range(data.GetNumberOfCells()))
    open(folder + '/points', 'wb').write(bytes(memoryview(data.GetPoints().GetData())))
    print(data.GetNumberOfPoints(), data.GetNumberOfCells())
else:
    print(*data.GetDimensions(), *data.GetOrigin(), *data.GetSpacing())
)";

class View : public testing::Test {
 protected:
  void SetUp() override {
    std::ofstream(here() / "tiny.toml") << one_case;
    ASSERT_EQ(bedload(here(), {"run", "tiny.toml", "--cores", "1"}).code, 0);
    std::ofstream(here() / "dump.py") << dump;
    const auto cases = here() / "tiny" / "cases";
    case_ = fs::directory_iterator(cases)->path();
    step_ = checkpoint_steps(case_).back();
  }
  /// What the reader found, printed by it; its arrays are then in here()/name.
  std::string read_by_vtk(const std::string& name, const std::string& moment) {
    fs::create_directory(here() / name);
    const auto file = case_ / "view" / (name + "-" + moment + ".hdf");
    const auto said = here() / (name + ".txt");
    const auto command = "/usr/bin/python3 '" + (here() / "dump.py").string() + "' '" + file.string() + "' '" +
                         (here() / name).string() + "' > '" + said.string() + "' 2>&1";
    EXPECT_EQ(std::system(command.c_str()), 0)
        << contents(said) << "this test needs the package python3-vtk9 (scripts/setup installs it)";
    return contents(said);
  }
  template <class Number>
  void expect_bits(const std::string& array, const Number* numbers, std::size_t n) {
    const auto bytes = contents(here() / array);
    ASSERT_EQ(bytes.size(), n * sizeof(Number)) << array;
    EXPECT_EQ(std::memcmp(bytes.data(), numbers, bytes.size()), 0) << array;
  }
  const fs::path& here() const { return directory_.path(); }
  std::string newest() const { return std::to_string(step_); }
  fs::path checkpoint() const { return case_ / ("ck-" + newest() + ".h5"); }

  fs::path case_;
  std::uint64_t step_ = 0;

 private:
  TemporaryDirectory directory_;
};

TEST_F(View, VtkReadsTheBitsOfTheCheckpoint) {
  const auto outcome = bedload(here(), {"view", "tiny.toml", case_.filename().string()});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_TRUE(outcome.out.starts_with("paraview '")) << outcome.out;
  EXPECT_TRUE(fs::exists(case_ / "view" / "case.xdmf"));
  const State state = read_checkpoint(checkpoint());

  EXPECT_EQ(read_by_vtk("grains", newest()), "100 100\n");
  const Grains& grains = state.grains;
  expect_bits("grains/points", grains.position.data(), 100);
  expect_bits("grains/velocity", grains.velocity.data(), 100);
  expect_bits("grains/spin", grains.spin.data(), 100);
  expect_bits("grains/diameter", grains.diameter.data(), 100);

  EXPECT_EQ(read_by_vtk("fluid", newest()), "5 3 12 0.0005 0.0005 0.00025 0.001 0.001 0.0005\n");
  StaggeredGrid grid{.cells = {5, 3, 12}};
  std::vector<double> velocity, pressure;
  const auto& [u, v, w] = state.fluid.velocity;
  for (int k = 0; k < 12; ++k)
    for (int j = 0; j < 3; ++j)
      for (int i = 0; i < 5; ++i) {
        const auto n = grid.index(i, j, k);
        velocity.push_back(0.5 * (u[n] + u[grid.index((i + 1) % 5, j, k)]));
        velocity.push_back(0.5 * (v[n] + v[grid.index(i, (j + 1) % 3, k)]));
        velocity.push_back(0.5 * ((k == 0 ? 0 : w[n]) + (k == 11 ? 0 : w[grid.index(i, j, k + 1)])));
        pressure.push_back(1000 * state.fluid.pressure[n]);
      }
  expect_bits("fluid/velocity", velocity.data(), velocity.size());
  expect_bits("fluid/pressure", pressure.data(), pressure.size());

  // The deposit conserves solid: what is missing of the void is the volume of the grains.
  std::vector<double> voids(pressure.size());
  const auto bytes = contents(here() / "fluid/void_fraction");
  ASSERT_EQ(bytes.size(), voids.size() * sizeof(double));
  std::memcpy(voids.data(), bytes.data(), bytes.size());
  double solid = 0, volume = 0;
  for (const double eps : voids) solid += (1 - eps) * 1e-3 * 1e-3 * 0.5e-3;
  for (const double d : grains.diameter) volume += M_PI / 6 * d * d * d;
  EXPECT_NEAR(solid, volume, 1e-12 * volume);
}

// Under the case's own fluid, which has not begun to flow.
TEST_F(View, ShowsTheSettledBed) {
  const auto outcome = bedload(here(), {"view", "tiny.toml", case_.filename().string() + "@bed"});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const State bed = read_checkpoint(case_ / "bed.h5");
  EXPECT_EQ(read_by_vtk("grains", "bed"), "100 100\n");
  expect_bits("grains/points", bed.grains.position.data(), 100);
  expect_bits("grains/diameter", bed.grains.diameter.data(), 100);
  EXPECT_EQ(read_by_vtk("fluid", "bed").substr(0, 7), "5 3 12 ");
  const std::vector<double> still(3 * 5 * 3 * 12, 0.0);
  expect_bits("fluid/velocity", still.data(), still.size());
  EXPECT_FALSE(fs::exists(case_ / "view" / ("grains-" + newest() + ".hdf")));
}

// Moves at once: the first hold of its ramp is the onset, and the settled bed comes before it.
TEST_F(View, ShowsTheBedAtOnset) {
  ASSERT_TRUE(fs::exists(case_ / "onset.h5"));
  ASSERT_EQ(bedload(here(), {"view", "tiny.toml", case_.filename().string()}).code, 0);
  const State onset = read_checkpoint(case_ / "onset.h5");
  EXPECT_EQ(read_by_vtk("grains", "onset"), "100 100\n");
  expect_bits("grains/velocity", onset.grains.velocity.data(), 100);
  const auto index = contents(case_ / "view" / "case.xdmf");
  const auto at_rest = index.find("grains-bed.hdf"), moving = index.find("grains-onset.hdf");
  EXPECT_LT(at_rest, moving) << index;
  EXPECT_NE(moving, std::string::npos) << index;
  EXPECT_NE(contents(here() / "tiny" / "report.html").find("at onset: end of hold 1, θ = "), std::string::npos);
}

void damage(const fs::path& file) {
  std::fstream bytes(file, std::ios::in | std::ios::out | std::ios::binary);
  bytes.seekp(5000).write("damaged", 7);
}

TEST_F(View, PassesOverABrokenCheckpointAndSaysSo) {
  const auto id = case_.filename().string();
  damage(checkpoint());
  const auto outcome = bedload(here(), {"view", "tiny.toml", id});
  EXPECT_EQ(outcome.code, 1) << outcome.err;
  EXPECT_NE(outcome.err.find("ck-" + newest() + ".h5"), std::string::npos) << outcome.err;
  EXPECT_TRUE(outcome.out.starts_with("paraview '")) << outcome.out;
  const auto index = contents(case_ / "view" / "case.xdmf");
  EXPECT_NE(index.find("grains-bed.hdf"), std::string::npos) << index;
  EXPECT_EQ(index.find("grains-" + newest() + ".hdf"), std::string::npos) << index;
  EXPECT_EQ(bedload(here(), {"view", "tiny.toml", id + "@" + newest()}).code, 76);
  for (const auto& entry : fs::directory_iterator(case_))
    if (entry.path().extension() == ".h5" && entry.path() != checkpoint()) damage(entry.path());
  EXPECT_EQ(bedload(here(), {"view", "tiny.toml", id}).code, 76);
}

TEST_F(View, SaysWhatIsMissing) {
  const auto id = case_.filename().string();
  EXPECT_EQ(bedload(here(), {"view", "tiny.toml", "nothing"}).code, 66);
  EXPECT_EQ(bedload(here(), {"view", "tiny.toml", id + "@x"}).code, 2);
  const auto other = bedload(here(), {"view", "tiny.toml", id + "@123456789"});
  EXPECT_EQ(other.code, 66);
  EXPECT_NE(other.err.find("it has those of steps"), std::string::npos) << other.err;
  ASSERT_EQ(bedload(here(), {"view", "tiny.toml", id + "@" + newest()}).code, 0);
  for (const auto* kept : {"bed.h5", "onset.h5"}) fs::remove(case_ / kept);
  for (const auto step : checkpoint_steps(case_)) fs::remove(case_ / ("ck-" + std::to_string(step) + ".h5"));
  const auto none = bedload(here(), {"view", "tiny.toml", id});
  EXPECT_EQ(none.code, 66);
  EXPECT_NE(none.err.find("has no checkpoint"), std::string::npos) << none.err;
}

}   // namespace
}   // namespace bedload
