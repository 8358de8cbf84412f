// What a kernel works on, moves and computes per second: where it stands below what the machine can do
// (machine_bench.cpp).
#pragma once

#include <benchmark/benchmark.h>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

namespace fusebench::testing {

/// The work of one run of a kernel.
struct KernelWork {
  std::string_view item;  ///< what there are so many of: "pixels", "rays"
  std::size_t items = 0;
  /// Compulsory traffic: each byte of the input in once, each byte of the output out once, as if caches held
  /// everything else. What a kernel really moves is at least this.
  double bytes = 0;
  /// Additions, multiplications, divisions and square roots of floating point that the formulas ask for, one
  /// each; 0 = not counted.
  double flop = 0;
};

/// Items, bytes and flop per second of all runs, the items of one run, and what they are as the label.
inline void report_rates(benchmark::State& state, const KernelWork& work) {
  using benchmark::Counter;
  const auto runs = static_cast<double>(state.iterations());
  state.SetItemsProcessed(std::llround(runs * static_cast<double>(work.items)));
  if (work.bytes > 0) state.SetBytesProcessed(std::llround(runs * work.bytes));
  state.counters["items"] = static_cast<double>(work.items);
  if (work.flop > 0) {
    state.counters["flop_per_second"] = Counter(work.flop, Counter::kIsIterationInvariantRate);
    if (work.bytes > 0) state.counters["flop_per_byte"] = work.flop / work.bytes;
  }
  state.SetLabel(std::string(work.item));
}

/// Bytes of so many values of a type, as a number to compute with.
template <class Value>
[[nodiscard]] double bytes_of(std::size_t count) {
  return static_cast<double>(sizeof(Value)) * static_cast<double>(count);
}

}  // namespace fusebench::testing
