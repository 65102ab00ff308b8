#include "solver/fluid/coarsest_solve.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <random>

namespace bedload {
namespace {

TEST(CoarsestSolve, SolvesAMatrixWhoseNullSpaceIsTheConstant) {
  std::mt19937 random(1);
  for (int n : {1, 2, 3, 17, 64}) {
    Eigen::MatrixXd a = Eigen::MatrixXd::Zero(n, n);
    for (int i = 0; i < n; ++i)
      for (int j = 0; j < i; ++j) {
        const double w = random() % 3 == 0 || j == i - 1 ? 0.01 + random() / 4294967296.0 : 0;
        a(i, i) += w, a(j, j) += w, a(i, j) -= w, a(j, i) -= w;
      }
    Eigen::VectorXd exact = Eigen::VectorXd::NullaryExpr(n, [&] { return random() / 4294967296.0; });
    exact.array() -= exact.mean();
    Eigen::VectorXd x = a * exact;
    CoarsestSolve solve;
    solve.factor(n, std::vector<double>(a.data(), a.data() + a.size()));
    solve.solve(x.data());
    EXPECT_LT((x - exact).cwiseAbs().maxCoeff(), 1e-12) << n;
  }
}

}   // namespace
}   // namespace bedload
