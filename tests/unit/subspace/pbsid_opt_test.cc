#include "core/subspace/pbsid_opt.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <complex>
#include <vector>

#include "core/subspace/eigenvalues.h"
#include "tests/unit/subspace/vector_arx.h"

namespace fatmc {
namespace {

std::vector<double> sorted_moduli(const Eigen::VectorXcd& values) {
  std::vector<double> out;
  for (const std::complex<double>& z : values) out.push_back(std::abs(z));
  std::sort(out.begin(), out.end());
  return out;
}

PbsidOptions plain(int past, int future, int order) {
  PbsidOptions options{past, future, order, {Regularization::fixed, 0.0}, FinalRegression::residual};
  return options;
}

TEST(PbsidOpt, FindsASystemWithoutNoiseWhosePredictorIsDeadBeatToRoundOff) {
  // An ARX system of order p has A_K^p = 0, so that nothing is truncated and nothing is left over.
  const std::vector<Maneuver> data{vector_arx(second_order(), 1, 300, 0.0, 0.0, 1)};
  auto factor = factor_predictor(data, 2);
  ASSERT_TRUE(factor.has_value());
  auto markov = solve_predictor(*factor, {Regularization::fixed, 0.0});
  ASSERT_TRUE(markov.has_value());
  const Eigen::MatrixXd expected = (Eigen::MatrixXd(1, 4) << 1.0, 1.5, 0.5, -0.7).finished();
  EXPECT_LT((markov->xi - expected).cwiseAbs().maxCoeff(), 1e-12);
  auto map = state_map(*factor, *markov, 2, 2);
  ASSERT_TRUE(map.has_value());
  PbsidOptions options = plain(2, 2, 2);
  // Innovations are zero here: the residual regression has nothing to find K from and has to say so.
  const auto refused = regress_model(data, *map, options);
  ASSERT_FALSE(refused.has_value());
  EXPECT_NE(refused.error().message.find("linearly dependent"), std::string::npos);
}

TEST(PbsidOpt, SmallNoiseLeavesErrorsOfItsOwnOrder) {
  for (const double sigma : {1e-4, 1e-6}) {
    const std::vector<Maneuver> data{vector_arx(second_order(), 1, 2000, sigma, 0.0, 2)};
    for (const FinalRegression final_regression : {FinalRegression::paper, FinalRegression::residual}) {
      PbsidOptions options = plain(2, 2, 2);
      options.final_regression = final_regression;
      const auto model = identify_pbsid(data, options);
      ASSERT_TRUE(model.has_value()) << model.error().message;
      EXPECT_NEAR(sorted_moduli(model->eigenvalues)[0], std::sqrt(0.7), sigma);
      EXPECT_NEAR(model->eigenvalues.real().sum(), 1.5, sigma);
      EXPECT_NEAR((model->c * model->b)(0, 0), 1.0, sigma);
      EXPECT_NEAR((model->c * model->a * model->b)(0, 0), 2.0, 2.0 * sigma);  // 1.5 * 1 + 0.5
      EXPECT_NEAR(model->innovation(0, 0), sigma * sigma, 0.1 * sigma * sigma);
    }
  }
}

struct SecondOrderErrors {
  double trace = 0.0, determinant = 0.0;  ///< mean errors in standard errors
  double trace_deviation = 0.0;           ///< standard error itself
};

/// 40 runs of three maneuvers each.
SecondOrderErrors repeated(FinalRegression final_regression, double feedback) {
  constexpr int kRuns = 40;
  Eigen::ArrayXd trace(kRuns), determinant(kRuns);
  for (int run = 0; run < kRuns; ++run) {
    std::vector<Maneuver> data;
    for (const std::uint64_t part : {0, 1, 2}) {
      data.push_back(vector_arx(second_order(), 1, 700, 0.5, feedback,
                                100 + 3 * static_cast<std::uint64_t>(run) + part));
    }
    PbsidOptions options = plain(6, 4, 2);
    options.final_regression = final_regression;
    const auto model = identify_pbsid(data, options);
    if (!model) return {1e9, 1e9, 1e9};
    trace(run) = model->a.trace();
    determinant(run) = model->a.determinant();
  }
  const auto standard_error = [](const Eigen::ArrayXd& x) {
    return std::sqrt((x - x.mean()).square().sum() / static_cast<double>(x.size() - 1) /
                     static_cast<double>(x.size()));
  };
  return {(trace.mean() - 1.5) / standard_error(trace),
          (determinant.mean() - 0.7) / standard_error(determinant), standard_error(trace)};
}

TEST(PbsidOpt, IsUnbiasedInOpenLoopByBothFinalRegressions) {
  for (const FinalRegression final_regression : {FinalRegression::paper, FinalRegression::residual}) {
    const SecondOrderErrors errors = repeated(final_regression, 0.0);
    EXPECT_LT(std::abs(errors.trace), 3.0);
    EXPECT_LT(std::abs(errors.determinant), 3.0);
    EXPECT_LT(errors.trace_deviation, 0.005);  // the band means something
  }
}

TEST(PbsidOpt, FeedbackWithoutDelayBiasesThePapersFinalRegressionAlone) {
  const SecondOrderErrors residual = repeated(FinalRegression::residual, 0.3);
  EXPECT_LT(std::abs(residual.trace), 3.0);
  EXPECT_LT(std::abs(residual.determinant), 3.0);
  EXPECT_LT(repeated(FinalRegression::paper, 0.3).trace, -10.0);  // u_t and e_t are correlated
}

TEST(PbsidOpt, SaysWhichWindowOrOrderTheDataCannotCarry) {
  std::vector<Maneuver> data{vector_arx(second_order(), 1, 60, 0.1, 0.0, 3)};
  const auto message = [&](int past, int future, int order) {
    const auto model = identify_pbsid(data, plain(past, future, order));
    return model ? std::string() : model.error().message;
  };
  EXPECT_EQ(largest_past_window(data), 20);
  EXPECT_NE(message(21, 2, 2).find("the largest for these maneuvers is 20"), std::string::npos);
  EXPECT_NE(message(2, 3, 2).find("between 1 and the past window, 2"), std::string::npos);
  EXPECT_NE(message(3, 2, 3).find("lengthen the future"), std::string::npos);
  EXPECT_NE(message(0, 1, 1).find("at least 1 sample"), std::string::npos);
}

TEST(PbsidOpt, NamesAnInputThatIsACombinationOfTheOthers) {
  Maneuver maneuver = vector_arx(second_order(), 1, 60, 0.1, 0.0, 4);
  maneuver.inputs.conservativeResize(Eigen::NoChange, 2);
  maneuver.inputs.col(1) = -2.0 * maneuver.inputs.col(0);
  const auto model = identify_pbsid(std::vector<Maneuver>{maneuver}, plain(3, 2, 2));
  ASSERT_FALSE(model.has_value());
  EXPECT_NE(model.error().message.find("linear combination"), std::string::npos);
}

TEST(PbsidOpt, NamesWhatDoesNotFitTogether) {
  const Maneuver good = vector_arx(second_order(), 1, 60, 0.1, 0.0, 4);
  Maneuver other = good, dead = good, holed = good;
  other.inputs.conservativeResize(Eigen::NoChange, 2);
  other.inputs.col(1).setZero();
  dead.outputs.setConstant(2.0);
  holed.outputs(5, 0) = std::nan("");
  const auto message = [](std::vector<Maneuver> data) { return check_maneuvers(data).error().message; };
  EXPECT_NE(message({good, other}).find("maneuver 2 has 2 inputs"), std::string::npos);
  EXPECT_NE(message({dead}).find("output 1 never moves"), std::string::npos);
  EXPECT_NE(message({holed}).find("not finite"), std::string::npos);
  EXPECT_TRUE(check_maneuvers(std::vector<Maneuver>{good, dead}).has_value());
}

TEST(PredictorRegression, FixedLambdaSolvesTheNormalEquationsOfTheRidge) {
  const std::vector<Maneuver> data{vector_arx(second_order(), 1, 200, 0.3, 0.2, 5)};
  const auto factor = factor_predictor(data, 5);
  ASSERT_TRUE(factor.has_value());
  const double lambda = 3.0;
  const auto ridge = solve_predictor(*factor, {Regularization::fixed, lambda});
  ASSERT_TRUE(ridge.has_value());
  const Eigen::MatrixXd gram = factor->r.transpose() * factor->r;
  const Eigen::MatrixXd shrunk = gram + lambda * lambda * Eigen::MatrixXd::Identity(10, 10);
  const Eigen::MatrixXd gradient = shrunk * ridge->xi.transpose() - factor->r.transpose() * factor->b;
  EXPECT_LT(gradient.norm(), 1e-11 * (factor->r.transpose() * factor->b).norm());
  EXPECT_NEAR(ridge->freedom, (shrunk.inverse() * gram).trace(), 1e-10);
}

TEST(PredictorRegression, GcvIsWhatLeavingOneOutGivesOnAverage) {
  // GCV with lambda -> the value that minimises (RSS/M)/(1 - tr/M)^2, checked against a brute-force hat
  // matrix.
  const std::vector<Maneuver> data{vector_arx(second_order(), 1, 80, 1.0, 0.0, 6)};
  const auto factor = factor_predictor(data, 8);
  ASSERT_TRUE(factor.has_value());
  const auto chosen = solve_predictor(*factor, {Regularization::gcv, 0.0});
  ASSERT_TRUE(chosen.has_value());
  const Eigen::MatrixXd gram = factor->r.transpose() * factor->r;
  const double m = static_cast<double>(factor->equations);
  const auto gcv = [&](double lambda) {
    const Eigen::MatrixXd inverse = (gram + lambda * lambda * Eigen::MatrixXd::Identity(16, 16)).inverse();
    const Eigen::MatrixXd xi = inverse * factor->r.transpose() * factor->b;
    const double rss = factor->residual.sum() + (factor->b - factor->r * xi).squaredNorm();
    const double left = 1.0 - (inverse * gram).trace() / m;
    return rss / m / (left * left);
  };
  const double step = std::pow(10.0, 1.0 / 20.0);
  EXPECT_LE(gcv(chosen->lambda), gcv(chosen->lambda * step));
  EXPECT_LE(gcv(chosen->lambda), gcv(chosen->lambda / step));
}

TEST(PredictorRegression, StrongRobustGcvRegularisesAtLeastAsMuchAsGcv) {
  for (const std::uint64_t run : {11, 12, 13, 14}) {
    const std::vector<Maneuver> data{vector_arx(second_order(), 1, 80, 1.0, 0.0, run)};
    const auto factor = factor_predictor(data, 8);
    ASSERT_TRUE(factor.has_value());
    const auto gcv = solve_predictor(*factor, {Regularization::gcv, 0.0});
    const auto strong = solve_predictor(*factor, {Regularization::srgcv, 0.0});
    ASSERT_TRUE(gcv.has_value() && strong.has_value());
    EXPECT_GE(strong->lambda, gcv->lambda);
  }
}

TEST(Eigenvalues, NormOfAPowerNeitherUnderflowsNorOverflowsOnTheWay) {
  const Eigen::MatrixXd m = (Eigen::MatrixXd(2, 2) << 0.5, 1.0, 0.0, 0.4).finished();
  Eigen::MatrixXd power = Eigen::MatrixXd::Identity(2, 2);
  for (int i = 0; i < 13; ++i) power = power * m;
  EXPECT_NEAR(spectral_norm_of_power(m, 13), spectral_norm(power), 1e-14 * spectral_norm(power));
  EXPECT_DOUBLE_EQ(spectral_norm_of_power(m, 0), 1.0);
  const Eigen::MatrixXd diagonal = Eigen::Vector2d(0.5, 0.25).asDiagonal();
  EXPECT_NEAR(spectral_norm_of_power(diagonal, 1000) / std::pow(0.5, 1000), 1.0, 1e-10);
}

}  // namespace
}  // namespace fatmc
