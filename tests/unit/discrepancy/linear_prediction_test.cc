#include "core/discrepancy/linear_prediction.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/random/random_stream.h"
#include "core/signal/dft.h"

namespace fatmc {
namespace {

constexpr double kRate = 25.0;

Eigen::MatrixXd normals(Eigen::Index rows, Eigen::Index cols, std::string_view name) {
  RandomStream random({1, name_hash("linear prediction"), 0, 0}, name);
  Eigen::MatrixXd out(rows, cols);
  for (Eigen::Index j = 0; j < cols; ++j) {
    for (Eigen::Index i = 0; i < rows; ++i) out(i, j) = random.normal();
  }
  return out;
}

/// A pair that doubles every 100 samples, one that rings, and a fast real mode; two inputs, two outputs, feedthrough.
SampledModel model() {
  SampledModel out{Eigen::MatrixXd::Zero(5, 5), normals(5, 2, "b"), normals(2, 5, "c"), normals(2, 2, "d")};
  const double growth = std::pow(2.0, 0.01);
  out.a.block<2, 2>(0, 0) << growth * std::cos(0.05), growth * std::sin(0.05), -growth * std::sin(0.05),
      growth * std::cos(0.05);
  out.a.block<2, 2>(2, 2) << 0.98 * std::cos(0.6), 0.98 * std::sin(0.6), -0.98 * std::sin(0.6),
      0.98 * std::cos(0.6);
  out.a(4, 4) = 0.2;
  return out;
}

Eigen::MatrixXd flown(const SampledModel& model, const Eigen::MatrixXd& inputs, Eigen::VectorXd x) {
  Eigen::MatrixXd out(inputs.rows(), model.c.rows());
  for (Eigen::Index t = 0; t < inputs.rows(); ++t) {
    const Eigen::VectorXd u = inputs.row(t).transpose();
    out.row(t) = (model.c * x + model.d * u).transpose();
    x = (model.a * x + model.b * u).eval();
  }
  return out;
}

Eigen::MatrixXcd spectra(const Eigen::MatrixXd& samples, Eigen::Index first, Eigen::Index count) {
  const RealDft dft(static_cast<int>(samples.rows()));
  Eigen::MatrixXcd all(samples.rows() / 2 + 1, samples.cols());
  for (Eigen::Index c = 0; c < samples.cols(); ++c)
    dft.transform({samples.col(c).data(), static_cast<std::size_t>(samples.rows())},
                  {all.col(c).data(), static_cast<std::size_t>(all.rows())});
  return all.middleRows(first, count);
}

struct Case {
  std::vector<double> frequency_hz;
  Eigen::MatrixXcd input, output;
};

Case case_of(const SampledModel& flown_model, int samples, double noise) {
  const Eigen::MatrixXd u = normals(samples, 2, "u");
  const Eigen::MatrixXd y = (flown(flown_model, u, normals(5, 1, "x0")).array() + 7.0).matrix() +
                            noise * normals(samples, 2, "v");  // an offset, which stands at m = 0
  Case out{{}, spectra(u, 1, 200), spectra(y, 1, 200)};
  for (int m = 1; m <= 200; ++m) out.frequency_hz.push_back(m * kRate / samples);
  return out;
}

TEST(LinearPrediction, LeavesNothingOfTheModelsOwnRecordUnstableAsItIs) {
  for (const int samples : {500, 501}) {
    const Case record = case_of(model(), samples, 0.0);
    const auto found =
        predict_linear(model(), kRate, samples, record.frequency_hz, record.input, record.output);
    ASSERT_TRUE(found) << found.error().message;
    EXPECT_LT(found->error.norm(), 1e-9 * record.output.norm());
  }
}

TEST(LinearPrediction, LeavesWhatAnotherPlantDoesOtherwise) {
  SampledModel other = model();
  other.b(4, 1) += 0.5;  // the fast mode takes more of the second input
  const Case record = case_of(other, 500, 0.0);
  const auto found = predict_linear(model(), kRate, 500, record.frequency_hz, record.input, record.output);
  ASSERT_TRUE(found);
  // 0.5 c z^-1/(1 - 0.2 z^-1) U_2, and its own start and end: what d cannot take.
  Eigen::MatrixXcd wanted(200, 2);
  for (Eigen::Index m = 0; m < 200; ++m) {
    const std::complex<double> z =
        std::polar(1.0, 2.0 * M_PI * record.frequency_hz[static_cast<std::size_t>(m)] / kRate);
    wanted.row(m) =
        (0.5 * model().c.col(4).cast<std::complex<double>>() / (z - 0.2) * record.input(m, 1)).transpose();
  }
  EXPECT_LT((found->error - wanted).norm(), 0.2 * wanted.norm());
  EXPECT_GT(found->error.norm(), 0.9 * wanted.norm());
}

TEST(LinearPrediction, KeepsTheNoise) {
  const Case record = case_of(model(), 500, 0.3);
  const auto found = predict_linear(model(), kRate, 500, record.frequency_hz, record.input, record.output);
  ASSERT_TRUE(found);
  // 400 complex values of variance 0.09, less 5 real parameters of 800; four deviations of the mean of 400.
  EXPECT_NEAR(found->error.squaredNorm() / 400.0, 0.09 * (1.0 - 5.0 / 800.0), 4.0 * 0.09 / std::sqrt(400.0));
}

TEST(LinearPrediction, SaysWhyThereIsNone) {
  const Case record = case_of(model(), 500, 0.0);
  const auto few =
      predict_linear(model(), kRate, 500, {0.05}, record.input.topRows(1), record.output.topRows(1));
  ASSERT_FALSE(few);
  EXPECT_NE(few.error().message.find("wider band"), std::string::npos);
  SampledModel ringing = model();
  ringing.a.setZero();
  ringing.a.block<2, 2>(0, 0) << 0.0, 1.0, -1.0, 0.0;  // +-j: a quarter of the rate, bin 125 of 500
  const auto pole = predict_linear(ringing, kRate, 500, record.frequency_hz, record.input, record.output);
  ASSERT_FALSE(pole);
  EXPECT_NE(pole.error().message.find("6.25 Hz"), std::string::npos);
}

}  // namespace
}  // namespace fatmc
