#ifndef HINDSIGHT_BASE_MEDIAN_H_
#define HINDSIGHT_BASE_MEDIAN_H_

#include <algorithm>
#include <cstddef>
#include <vector>

namespace hindsight {

/// The median of n values, of an even number the upper of the two in the
/// middle: number n / 2, counted from 0, in ascending order. Of none a
/// value-initialised one (0).
template <typename Value>
Value Median(std::vector<Value> values) {
  if (values.empty()) return Value();
  const auto middle =
      values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

}  // namespace hindsight

#endif  // HINDSIGHT_BASE_MEDIAN_H_
