#include "tissue/simulate/constitutive.h"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>

#include <random>

namespace {

using namespace tissue;

constexpr Constitution kAll[] = {Constitution::kLinear, Constitution::kCorotational,
                                 Constitution::kNeoHookean};
const Lame kLame = lame_of(5e4, 0.45);

Mat3 random_matrix(std::mt19937& generator) {
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  Mat3 result;
  for (int i = 0; i < 9; ++i) result(i) = uniform(generator);
  return result;
}

Mat3 turned(double degrees) {
  return Eigen::AngleAxisd(degrees * M_PI / 180.0, Vec3(1, 2, -1).normalized()).toRotationMatrix();
}

// Near and far from rest, turned, inside out, flat.
std::vector<Mat3> gradients_to_try() {
  std::mt19937 generator(11);
  std::vector<Mat3> result;
  for (int i = 0; i < 98; ++i) {
    const double size = i % 3 == 0 ? 0.1 : i % 3 == 1 ? 0.7 : 2.0;
    result.push_back(turned(40.0 * i) * (Mat3::Identity() + size * random_matrix(generator)));
  }
  result.push_back(Vec3(1.1, 0.9, 0.0).asDiagonal());
  result.push_back(Vec3(1.1, 0.9, -0.7).asDiagonal());
  return result;
}

TEST(Constitutive, T11_StressIsTheDerivativeOfEnergy) {
  for (const Constitution constitution : kAll) {
    for (const Mat3& f : gradients_to_try()) {
      const Mat3 exact = stress(constitution, kLame, f);
      const double h = 1e-6;
      for (int i = 0; i < 9; ++i) {
        Mat3 more = f, less = f;
        more(i) += h;
        less(i) -= h;
        const double difference = (energy_density(constitution, kLame, more) -
                                   energy_density(constitution, kLame, less)) /
                                  (2.0 * h);
        EXPECT_NEAR(difference, exact(i), 1e-6 * (exact.norm() + kLame.lambda)) << f;
      }
    }
  }
}

TEST(Constitutive, T11_StiffnessIsTheDerivativeOfStress) {
  for (const Constitution constitution : kAll) {
    for (const Mat3& f : gradients_to_try()) {
      const Mat9 exact = stiffness(constitution, kLame, f);
      const double h = 1e-6;
      for (int i = 0; i < 9; ++i) {
        Mat3 more = f, less = f;
        more(i) += h;
        less(i) -= h;
        const Mat3 difference =
            (stress(constitution, kLame, more) - stress(constitution, kLame, less)) / (2.0 * h);
        const Eigen::Map<const Eigen::Matrix<double, 9, 1>> column(difference.data());
        EXPECT_LE((column - exact.col(i)).norm(), 1e-5 * exact.norm()) << f;
      }
    }
  }
}

TEST(Constitutive, T11_ConvexStiffnessHasNoNegativeEigenvalueAndIsElseTheSame) {
  for (const Constitution constitution : kAll) {
    int unchanged = 0;
    for (const Mat3& f : gradients_to_try()) {
      const Mat9 exact = stiffness(constitution, kLame, f);
      const Mat9 convex = convex_stiffness(constitution, kLame, f);
      const Eigen::SelfAdjointEigenSolver<Mat9> of_exact(exact), of_convex(convex);
      EXPECT_GE(of_convex.eigenvalues()[0], -1e-10 * of_convex.eigenvalues()[8]);
      const Mat9 projected = of_exact.eigenvectors() *
                             of_exact.eigenvalues().cwiseMax(0.0).asDiagonal() *
                             of_exact.eigenvectors().transpose();
      EXPECT_LE((projected - convex).norm(), 1e-9 * exact.norm()) << f;
      unchanged += of_exact.eigenvalues()[0] > 0.0;
    }
    // Small strain is convex everywhere; the others have had something to mend.
    if (constitution != Constitution::kLinear) {
      EXPECT_LT(unchanged, 100);
    }
  }
}

TEST(Constitutive, T10_RigidMotionHasNeitherEnergyNorStress) {
  for (double degrees = 0.0; degrees <= 720.0; degrees += 30.0) {
    for (const Constitution constitution :
         {Constitution::kCorotational, Constitution::kNeoHookean}) {
      EXPECT_NEAR(energy_density(constitution, kLame, turned(degrees)), 0.0, 1e-9);
      EXPECT_LE(stress(constitution, kLame, turned(degrees)).norm(), 1e-9 * kLame.lambda);
    }
  }
}

TEST(Constitutive, T10_TheNearestRotationIsOneAlsoForSingularAndReflectedGradients) {
  for (const Mat3& f : gradients_to_try()) {
    const Mat3 rotation = nearest_rotation(f);
    EXPECT_NEAR(rotation.determinant(), 1.0, 1e-12);
    EXPECT_LE((rotation * rotation.transpose() - Mat3::Identity()).norm(), 1e-12);
  }
  EXPECT_NEAR(nearest_rotation(Mat3::Zero()).determinant(), 1.0, 1e-12);
}

TEST(Constitutive, SmallStrainsCostTheSameInEveryModel) {
  std::mt19937 generator(5);
  for (int i = 0; i < 20; ++i) {
    Mat3 strain = random_matrix(generator);
    strain = 1e-4 * (strain + strain.transpose());
    const Mat3 f = Mat3::Identity() + strain;
    const double linear = energy_density(Constitution::kLinear, kLame, f);
    for (const Constitution constitution :
         {Constitution::kCorotational, Constitution::kNeoHookean}) {
      EXPECT_NEAR(energy_density(constitution, kLame, f), linear, 2e-3 * linear);
    }
  }
}

}  // namespace
