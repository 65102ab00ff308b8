#include "solver/grains/grain_table.hpp"

#include <gtest/gtest.h>

#include "base/error.hpp"
#include "solver/grains/bed_packing.hpp"
#include "tests/solver/grains/grain_scenes.hpp"

namespace bedload {
namespace {

const std::string header = "x,y,z,diameter,density,fixed\n";

BedScene with_table(const std::string& csv) {
  BedScene scene = grain_scene(Side::periodic, Side::wall);
  scene.source = {BedSource::Kind::file, 0, csv, 1};
  return scene;
}

std::string refusal(const std::string& csv) {
  try {
    place_grains(with_table(csv));
  } catch (const Error& error) {
    EXPECT_EQ(error.kind, ErrorKind::study_invalid);
    return error.what();
  }
  return "accepted";
}

TEST(GrainTable, ReadsGrainsInOrderAtRest) {
  const Grains grains =
      place_grains(with_table(header + "0.01,0.02,0.03,1e-3,2500,0\r\n\n 0.012 , 0.02,0.03,0.002,3000,1\n"));
  ASSERT_EQ(grains.size(), 2u);
  EXPECT_EQ(grains.position[0], (Vec3{0.01, 0.02, 0.03}));
  EXPECT_EQ(grains.diameter[1], 0.002);
  EXPECT_EQ(grains.density[1], 3000);
  EXPECT_EQ(grains.fixed[0], 0);
  EXPECT_EQ(grains.fixed[1], 1);
  EXPECT_EQ(grains.velocity[1], Vec3{});
}

TEST(GrainTable, ReadsVelocityAndSpinWhereTheHeaderHasThem) {
  const std::string moving = "x,y,z,diameter,density,fixed,vx,vy,vz,wx,wy,wz\n";
  const Grains grains = place_grains(with_table(moving + "0.01,0.02,0.03,1e-3,2500,0,1,-2,3,40,50,-60\n"));
  EXPECT_EQ(grains.velocity.at(0), (Vec3{1, -2, 3}));
  EXPECT_EQ(grains.spin.at(0), (Vec3{40, 50, -60}));
  EXPECT_NE(refusal(moving + "0.01,0.02,0.03,1e-3,2500,0\n").find("row 2: 6 columns"), std::string::npos);
  EXPECT_NE(refusal(moving + "0.01,0.02,0.03,1e-3,2500,1,1,0,0,0,0,0\n").find("a fixed grain has a velocity"),
            std::string::npos);
}

TEST(GrainTable, ReadsVelocityOrSpinAlone) {
  const std::string columns = header.substr(0, header.size() - 1), row = "0.01,0.02,0.03,1e-3,2500,0,1,-2,3\n";
  const Grains thrown = place_grains(with_table(columns + ",vx,vy,vz\n" + row));
  EXPECT_EQ(thrown.velocity.at(0), (Vec3{1, -2, 3}));
  EXPECT_EQ(thrown.spin.at(0), Vec3{});
  const Grains spun = place_grains(with_table(columns + ",wx,wy,wz\n" + row));
  EXPECT_EQ(spun.velocity.at(0), Vec3{});
  EXPECT_EQ(spun.spin.at(0), (Vec3{1, -2, 3}));
  for (const std::string extra : {",wx,wy,wz,vx,vy,vz", ",vx,vy", ",vx,vy,vz,", ",vx,vy,vz,vx,vy,vz"})
    EXPECT_NE(refusal(columns + extra + "\n" + row).find("row 1: the header is"), std::string::npos) << extra;
  EXPECT_NE(refusal(columns + ",wx,wy,wz\n0.01,0.02,0.03,1e-3,2500,0,1,fast,3\n").find("row 2: wy = \"fast\""),
            std::string::npos);
}

TEST(GrainTable, RefusesATableWithoutGrains) {
  EXPECT_EQ(refusal(header), "the table has a header and no grains");
  EXPECT_EQ(refusal(header + "\r\n\n"), "the table has a header and no grains");
}

TEST(GrainTable, MayBeginWithTheByteOrderMarkOfASpreadsheet) {
  EXPECT_EQ(place_grains(with_table("\xEF\xBB\xBF" + header + "0.01,0.02,0.03,1e-3,2500,0\n")).size(), 1u);
}

TEST(GrainTable, AcceptsAGrainOnTheSeam) {
  EXPECT_EQ(place_grains(with_table(header + "0.04,0.02,0.03,1e-3,2500,0\n")).position[0].x, 0);
}

TEST(GrainTable, NamesTheRowOfWhatItCannotRead) {
  EXPECT_NE(refusal("x,y,z,d\n").find("row 1"), std::string::npos);
  EXPECT_NE(refusal("").find("row 1"), std::string::npos);
  EXPECT_NE(refusal(header + "0.01,0.01,0.01,1e-3,2500,0\n0.02,0.01,oops,1e-3,2500,0\n").find("row 3: z = \"oops\""),
            std::string::npos);
  EXPECT_NE(refusal(header + "0.01,0.01,0.01,1e-3,2500\n").find("row 2: 5 columns"), std::string::npos);
  EXPECT_NE(refusal(header + "0.01,nan,0.01,1e-3,2500,0\n").find("row 2: y"), std::string::npos);
  EXPECT_NE(refusal(header + "0.01,0.01,0.01,1e-3,2500,2\n").find("fixed"), std::string::npos);
}

TEST(GrainTable, RefusesGrainsWithoutSizeOrMassOrOutsideTheBox) {
  EXPECT_NE(refusal(header + "0.01,0.01,0.01,0,2500,0\n").find("diameter"), std::string::npos);
  EXPECT_NE(refusal(header + "0.01,0.01,0.01,-1e-3,2500,0\n").find("diameter"), std::string::npos);
  EXPECT_NE(refusal(header + "0.01,0.01,0.01,1e-3,0,0\n").find("density"), std::string::npos);
  EXPECT_NE(refusal(header + "0.05,0.01,0.01,1e-3,2500,0\n").find("outside the box"), std::string::npos);
  EXPECT_NE(refusal(header + "0.01,0.01,0.0002,1e-3,2500,0\n").find("outside the box"), std::string::npos)
      << "in the floor";
  EXPECT_EQ(refusal(header + "0.01,0.01,0.0002,1e-3,2500,1\n"), "accepted") << "a rough floor of fixed grains";
}

TEST(GrainTable, RefusesOverlapsButNotThoseOfASettledBed) {
  const std::string first = header + "0.0002,0.01,0.01,1e-3,2500,0\n";
  EXPECT_NE(refusal(first + "0.0002,0.01,0.01,1e-3,2500,0\n").find("rows 2 and 3: two grains at one place"),
            std::string::npos);
  EXPECT_NE(refusal(first + "0.0007,0.01,0.01,1e-3,2500,0\n").find("rows 2 and 3: the grains overlap"),
            std::string::npos);
  EXPECT_NE(refusal(first + "0.0398,0.01,0.01,1e-3,2500,0\n").find("overlap"), std::string::npos) << "across the seam";
  EXPECT_EQ(refusal(first + "0.001195,0.01,0.01,1e-3,2500,0\n"), "accepted") << "by half a per cent";
}

}   // namespace
}   // namespace bedload
