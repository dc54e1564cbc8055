#include "routebench/harness/metrics.hpp"

#include <gtest/gtest.h>

#include <set>
#include <string>
#include <string_view>

#include "routebench/geometry/error.hpp"

namespace routebench {
namespace {

TEST(Metrics, NamesAreUniqueAndLeadBackToTheirPlace) {
  std::set<std::string_view> names;
  std::size_t place = 0;
  for (const MetricInfo& metric : metric_table()) {
    EXPECT_TRUE(names.insert(metric.name).second) << metric.name;
    EXPECT_EQ(metric_index(metric.name), place++);
    EXPECT_FALSE(metric.label.empty());
    EXPECT_FALSE(metric.meaning.empty());
    EXPECT_EQ(metric.meaning.find('\n'), std::string_view::npos);
  }
}

TEST(Metrics, UnitsAreThoseThatNamesEndIn) {
  for (const MetricInfo& metric : metric_table()) {
    const std::size_t underscore = metric.name.rfind('_');
    const std::string_view ending =
        underscore == metric.name.npos ? "" : metric.name.substr(underscore + 1);
    for (const std::string_view unit : {"mm", "mm3", "s", "ns", "bytes"})
      EXPECT_EQ(ending == unit, metric.unit == unit) << metric.name;
  }
}

TEST(Metrics, UnknownNamesAreRefusedWithTheNearestOne) {
  try {
    static_cast<void>(metric_index("travel_m"));
    FAIL() << "not refused";
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::kBadUsage);
    EXPECT_NE(std::string(error.what()).find("'travel_mm'"), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace routebench
