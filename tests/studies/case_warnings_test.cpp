// Warnings of many cases: once each, and no case forgotten.
#include "studies/case_warnings.hpp"

#include <gtest/gtest.h>

namespace bedload {
namespace {

TEST(CaseWarnings, AreSaidOnceForAllCasesThatTheyHoldFor) {
  const auto shared =
      shared_warnings({{"b", "too shallow"}, {"b", "Re = 2e+03 > 1"}, {"a", "Re = 10.5 > 1"}, {"c", "too shallow"}});
  ASSERT_EQ(shared.size(), 2u);
  EXPECT_EQ(shared[0].text, "too shallow");
  EXPECT_EQ(shared[0].labels, (std::vector<std::string>{"b", "c"}));
  EXPECT_EQ(cases_in_words(shared[0]), "b and 1 more");
  EXPECT_EQ(shared[1].text, "Re = 2e+03 > 1");
  EXPECT_EQ(cases_in_words(shared[1]), "b and 1 more with their own numbers");
}

TEST(CaseWarnings, DifferByWhatIsNoNumber) {
  const auto shared = shared_warnings({{"a", "law stokes up to 1"}, {"b", "law rong up to 1"}});
  ASSERT_EQ(shared.size(), 2u);
  EXPECT_EQ(cases_in_words(shared[1]), "b");
}

}   // namespace
}   // namespace bedload
