// The short form of the matrix of the extremes, as a user runs it.
#include <gtest/gtest.h>

#include "base/durable_file.hpp"
#include "tests/end_to_end/bedload_program.hpp"
#include "tests/support/temporary_directory.hpp"

namespace bedload {
namespace {

TEST(Extremes, OfTheShortFormAreAllAsTheyMustBe) {
  const TemporaryDirectory directory;
  const auto run = bedload(directory.path(),
                           {"validate", "extremes", "--quick", "--cores", "2", "--json", "--write", "deep/my docs"});
  EXPECT_EQ(run.code, 0) << run.err;
  EXPECT_NE(run.out.find("\"outcome\""), std::string::npos);
  const std::string document = read_text(directory.path() / "deep/my docs/extremes.md");
  EXPECT_NE(document.find("Written by `bedload validate extremes --quick --cores 2 --write 'deep/my docs'`"),
            std::string::npos);
  EXPECT_NE(document.find("| friction 0 | finished |"), std::string::npos);
  EXPECT_NE(document.find("| more grains than fit | refused |"), std::string::npos);
  EXPECT_EQ(document.find("**"), std::string::npos);   // no verdict that stands out
}

}   // namespace
}   // namespace bedload
