#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <map>
#include <string>
#include <utility>

namespace tissue_test {

/// Keeps the largest `value` of `what` that the running test comes upon among its results, where
/// scripts/robustness finds it.
inline void figure(const std::string& what, double value) {
  static std::map<std::pair<std::string, std::string>, double> largest;
  const testing::TestInfo* const test = testing::UnitTest::GetInstance()->current_test_info();
  double& known =
      largest.emplace(std::pair(std::string(test->test_suite_name()) + test->name(), what), value)
          .first->second;
  known = std::max(known, value);
  char text[32];
  std::snprintf(text, sizeof text, "%.3g", known);
  testing::Test::RecordProperty(what, text);
}

}  // namespace tissue_test
