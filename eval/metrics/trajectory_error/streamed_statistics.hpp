// Statistics of more values than there is memory for.
#pragma once

#include <functional>

#include "eval/metrics/statistics.hpp"

namespace fusebench::trajectory_error {

using ValueVisitor = std::function<void(double)>;
/// Gives its values to the visitor one by one: the same ones in the same order whenever it is called.
using ValueSource = std::function<void(const ValueVisitor&)>;

/// What statistics() says of the values, to the bit, in 1 MiB however many they are: calls the source four
/// times, and finds the median by 16 bits of its pattern at a time. Values must be finite.
[[nodiscard]] metrics::Statistics streamed_statistics(const ValueSource& source);

}  // namespace fusebench::trajectory_error
