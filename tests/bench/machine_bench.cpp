// What the machine can do, measured in the program that measures the kernels: the roofs that they stand
// below. Working sets are powers of two (kB); which cache one lies in depends on the machine. One thread.
#include <benchmark/benchmark.h>

#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <random>
#include <span>
#include <utility>
#include <vector>

#include "core/base/simd/lanes.hpp"
#include "tests/bench/rates.hpp"

namespace fusebench {

using namespace simd;

namespace {

using testing::report_rates;

/// What does not wait for each other: additions take a few cycles, of which a processor starts two in each.
constexpr std::size_t kChains = 8;

std::size_t working_set_bytes(const benchmark::State& state) {
  return static_cast<std::size_t>(state.range(0)) * 1024;
}

/// 0, 1, 2 or 3, without a pattern. Single precision adds up five million of them without rounding.
float small_number(std::size_t i) {
  return static_cast<float>((static_cast<std::uint32_t>(i) * 2654435769U) >> 30);
}

std::vector<Float8> small_numbers(std::size_t count) {
  std::vector<Float8> numbers(count);
  for (std::size_t i = 0; i < count; ++i) {
    for (std::size_t lane = 0; lane < kLanes; ++lane) numbers[i][lane] = small_number(kLanes * i + lane);
  }
  return numbers;
}

double sum_of(const std::array<Float8, kChains>& sums) {
  double sum = 0;
  for (const Float8& lanes : sums) sum += sum_of_lanes(lanes);
  return sum;
}

[[gnu::noinline]] double sum_of(std::span<const Float8> numbers) {
  std::array<Float8, kChains> sums{};
  for (std::size_t i = 0; i + kChains <= numbers.size(); i += kChains) {
    for (std::size_t chain = 0; chain < kChains; ++chain) sums[chain] += numbers[i + chain];
  }
  return sum_of(sums);
}

/// Reads from the first number to the last.
void machine_read(benchmark::State& state) {
  const std::size_t bytes = working_set_bytes(state);
  const std::vector<Float8> numbers = small_numbers(bytes / sizeof(Float8));
  double expected = 0;
  for (std::size_t i = 0; i < kLanes * numbers.size(); ++i) expected += static_cast<double>(small_number(i));
  if (sum_of(numbers) != expected) return state.SkipWithError("not the sum of the numbers");
  for (auto _ : state) {
    benchmark::DoNotOptimize(sum_of(numbers));
    benchmark::ClobberMemory();
  }
  report_rates(state, {"numbers", kLanes * numbers.size(), static_cast<double>(bytes)});
}

[[gnu::noinline]] void triad(std::span<Float8> a, std::span<const Float8> b, std::span<const Float8> c,
                             float factor) {
  for (std::size_t i = 0; i < a.size(); ++i) a[i] = b[i] + factor * c[i];
}

/// a = b + factor * c (McCalpin's STREAM) with all three in the working set. As there, what is written counts
/// once, though its cache lines are read before that.
void machine_triad(benchmark::State& state) {
  const std::size_t count = working_set_bytes(state) / (3 * sizeof(Float8));
  const std::vector<Float8> b = small_numbers(count);
  const std::vector<Float8> c = small_numbers(count);
  std::vector<Float8> a(count);
  triad(a, b, c, 2.0F);
  for (std::size_t i = 0; i < kLanes * count; ++i) {
    if (a[i / kLanes][i % kLanes] != 3.0F * small_number(i))
      return state.SkipWithError("not the sum of both");
  }
  for (auto _ : state) {
    triad(a, b, c, 2.0F);
    benchmark::ClobberMemory();
  }
  const double numbers = static_cast<double>(kLanes * count);
  report_rates(state, {"numbers", kLanes * count, 3 * sizeof(float) * numbers, 2 * numbers});
}

/// Random places of a table, eight at a time: Marsaglia's xorshift32 (2003) in each lane, which costs little
/// beside a gather.
using Bits8 [[gnu::vector_size(32)]] = std::uint32_t;

template <class Bits>
Bits next_random(Bits bits) {
  bits ^= bits << 13;
  bits ^= bits >> 17;
  return bits ^ (bits << 5);
}

/// Goes on where it was, so that no call meets the places of another one in the caches.
class RandomGathers {
 public:
  RandomGathers() {
    std::uint32_t seed = 1;
    for (Bits8& eight : bits_) {
      for (std::size_t lane = 0; lane < kLanes; ++lane) eight[lane] = seed++ * 2654435769U;
    }
  }

  static constexpr std::size_t kSteps = 1024;
  static constexpr std::size_t kNumbers = kSteps * kChains * kLanes;

  /// Sum of kNumbers places of a table whose size is a power of two.
  [[gnu::noinline]] double gathered(std::span<const float> table) {
    const auto mask = static_cast<std::uint32_t>(table.size() - 1);
    std::array<Bits8, kChains> bits = bits_;
    std::array<Float8, kChains> sums{};
    for (std::size_t step = 0; step < kSteps; ++step) {
      for (std::size_t chain = 0; chain < kChains; ++chain) {
        bits[chain] = next_random(bits[chain]);
        sums[chain] += gather(table.data(), std::bit_cast<Int8>(bits[chain] & mask));
      }
    }
    bits_ = bits;
    return sum_of(sums);
  }

  /// The same, one number after the other.
  [[nodiscard]] double expected(std::span<const float> table) const {
    double sum = 0;
    for (const Bits8& eight : bits_) {
      for (std::size_t lane = 0; lane < kLanes; ++lane) {
        std::uint32_t bits = eight[lane];
        for (std::size_t step = 0; step < kSteps; ++step) {
          bits = next_random(bits);
          sum += static_cast<double>(table[bits & (table.size() - 1)]);
        }
      }
    }
    return sum;
  }

 private:
  std::array<Bits8, kChains> bits_;
};

void machine_gather(benchmark::State& state) {
  std::vector<float> table(working_set_bytes(state) / sizeof(float));
  for (std::size_t i = 0; i < table.size(); ++i) table[i] = small_number(i);
  RandomGathers gathers;
  const double expected = gathers.expected(table);
  if (gathers.gathered(table) != expected) return state.SkipWithError("not the sum of these places");
  for (auto _ : state) benchmark::DoNotOptimize(gathers.gathered(table));
  // The numbers alone; caches move 64 bytes for each that they do not have.
  report_rates(state, {"numbers", RandomGathers::kNumbers, sizeof(float) * RandomGathers::kNumbers});
}

/// A multiplication and an addition, rounded once, a step in each chain.
template <std::size_t kCount>
[[gnu::noinline]] std::array<Float8, kCount> multiplied_and_added(std::size_t steps, float factor,
                                                                  float summand) {
  std::array<Float8, kCount> values;
  for (std::size_t chain = 0; chain < kCount; ++chain)
    values[chain] = kLaneNumber + static_cast<float>(chain);
  for (std::size_t step = 0; step < steps; ++step) {
    for (Float8& value : values) value = multiply_add(value, all_lanes(factor), all_lanes(summand));
  }
  return values;
}

template <std::size_t kCount>
void machine_mul_add(benchmark::State& state) {
  constexpr std::size_t kSteps = 4096;
  constexpr float kFactor = 0.75F;
  constexpr float kSummand = 1.25F;
  const auto run = [&] { return multiplied_and_added<kCount>(kSteps, kFactor, kSummand); };
  const std::array<Float8, kCount> values = run();
  for (std::size_t i = 0; i < kCount * kLanes; ++i) {
    auto expected = static_cast<float>(i % kLanes + i / kLanes);
    for (std::size_t step = 0; step < kSteps; ++step) expected = std::fma(expected, kFactor, kSummand);
    if (values[i / kLanes][i % kLanes] != expected) return state.SkipWithError("not what one number becomes");
  }
  for (auto _ : state) benchmark::DoNotOptimize(run());
  report_rates(state, {"steps", kSteps * kCount, 0, 2.0 * kLanes * kSteps * kCount});
}

/// One link in each cache line.
struct alignas(64) Link {
  std::uint32_t next = 0;
};

/// A way through all links in random order, back to the first (Sattolo 1986).
std::vector<Link> random_cycle(std::size_t count) {
  std::vector<Link> links(count);
  for (std::size_t i = 0; i < count; ++i) links[i].next = static_cast<std::uint32_t>(i);
  std::mt19937 random(1);
  for (std::size_t i = count - 1; i > 0; --i) {
    std::uniform_int_distribution<std::size_t> earlier(0, i - 1);
    std::swap(links[i].next, links[earlier(random)].next);
  }
  return links;
}

[[gnu::noinline]] std::uint32_t followed(std::span<const Link> links, std::uint32_t at, std::size_t steps) {
  for (std::size_t step = 0; step < steps; ++step) at = links[at].next;
  return at;
}

/// Each load says where the next one goes.
void machine_latency(benchmark::State& state) {
  constexpr std::size_t kSteps = 1 << 15;
  const std::vector<Link> links = random_cycle(working_set_bytes(state) / sizeof(Link));
  std::vector<bool> seen(links.size());
  std::uint32_t at = 0;
  for (std::size_t i = 0; i < links.size(); ++i, at = links[at].next) seen[at] = true;
  if (at != 0 || followed(links, 0, links.size()) != 0 ||
      std::accumulate(seen.begin(), seen.end(), std::size_t{0}) != links.size())
    return state.SkipWithError("not a way through all links");
  for (auto _ : state) benchmark::DoNotOptimize(at = followed(links, at, kSteps));
  report_rates(state, {"loads", kSteps, static_cast<double>(sizeof(Link) * kSteps)});
  using benchmark::Counter;
  state.counters["s_per_load"] =
      Counter(static_cast<double>(kSteps), Counter::kIsIterationInvariantRate | Counter::kInvert);
}

constexpr std::int64_t kMegabyte = 1024;  // of kB

BENCHMARK(machine_read)->ArgName("kB")->Arg(32)->Arg(kMegabyte)->Arg(16 * kMegabyte)->Arg(512 * kMegabyte);
BENCHMARK(machine_triad)->ArgName("kB")->Arg(32)->Arg(kMegabyte)->Arg(16 * kMegabyte)->Arg(512 * kMegabyte);
BENCHMARK(machine_gather)->ArgName("kB")->Arg(32)->Arg(kMegabyte)->Arg(32 * kMegabyte);
BENCHMARK(machine_mul_add<1>);
BENCHMARK(machine_mul_add<2>);
BENCHMARK(machine_mul_add<4>);
BENCHMARK(machine_mul_add<8>);
BENCHMARK(machine_mul_add<12>);
BENCHMARK(machine_latency)->ArgName("kB")->Arg(32)->Arg(kMegabyte)->Arg(32 * kMegabyte)->Arg(512 * kMegabyte);

}  // namespace
}  // namespace fusebench
