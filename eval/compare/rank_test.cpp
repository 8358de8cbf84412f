#include "eval/compare/rank_test.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

namespace fusebench::compare {

namespace {

constexpr std::size_t kMostForExact = 40;

struct Ranks {
  double u = 0;
  double tie_sum = 0;  // of t^3 - t over groups of t equal numbers
};

Ranks ranks_of(std::span<const double> earlier, std::span<const double> later) {
  struct Entry {
    double value;
    bool later;
  };
  std::vector<Entry> all;
  for (const double value : earlier) all.push_back({value, false});
  for (const double value : later) all.push_back({value, true});
  std::ranges::sort(all, {}, &Entry::value);
  Ranks ranks;
  double rank_sum = 0;
  for (std::size_t begin = 0; begin < all.size();) {
    std::size_t end = begin;
    std::size_t of_later = 0;
    for (; end < all.size() && all[end].value == all[begin].value; ++end) {
      if (all[end].later) ++of_later;
    }
    const double mean_rank = 0.5 * static_cast<double>(begin + 1 + end);
    rank_sum += mean_rank * static_cast<double>(of_later);
    const auto tied = static_cast<double>(end - begin);
    ranks.tie_sum += tied * tied * tied - tied;
    begin = end;
  }
  const auto n = static_cast<double>(later.size());
  ranks.u = rank_sum - n * (n + 1) / 2;
  return ranks;
}

/// ways[s]: how many sets of `chosen` of the ranks 1 .. total have the sum s. All are integers below 2^53.
std::vector<double> ways_of_rank_sums(std::size_t total, std::size_t chosen) {
  const std::size_t largest = total * (total + 1) / 2;
  std::vector<std::vector<double>> ways(chosen + 1, std::vector<double>(largest + 1, 0.0));
  ways[0][0] = 1;
  for (std::size_t rank = 1; rank <= total; ++rank) {
    for (std::size_t k = std::min(rank, chosen); k > 0; --k) {
      for (std::size_t sum = largest; sum >= rank; --sum) ways[k][sum] += ways[k - 1][sum - rank];
    }
  }
  return ways[chosen];
}

double exact_p(std::size_t n_earlier, std::size_t n_later, double u) {
  const std::vector<double> ways = ways_of_rank_sums(n_earlier + n_later, n_later);
  const double least_sum = u + static_cast<double>(n_later * (n_later + 1)) / 2;
  double at_least = 0;
  double all = 0;
  for (std::size_t sum = 0; sum < ways.size(); ++sum) {
    all += ways[sum];
    if (static_cast<double>(sum) >= least_sum) at_least += ways[sum];
  }
  return at_least / all;
}

double normal_p(std::size_t n_earlier, std::size_t n_later, const Ranks& ranks) {
  const auto n1 = static_cast<double>(n_earlier);
  const auto n2 = static_cast<double>(n_later);
  const double n = n1 + n2;
  const double variance = n1 * n2 / 12 * (n + 1 - ranks.tie_sum / (n * (n - 1)));
  if (!(variance > 0)) return 1;
  constexpr double kContinuity = 0.5;
  const double z = (ranks.u - n1 * n2 / 2 - kContinuity) / std::sqrt(variance);
  return 0.5 * std::erfc(z / std::numbers::sqrt2);
}

}  // namespace

RankTest test_larger(std::span<const double> earlier, std::span<const double> later) {
  if (earlier.empty() || later.empty()) return {};
  const Ranks ranks = ranks_of(earlier, later);
  const bool exact = ranks.tie_sum == 0 && earlier.size() + later.size() <= kMostForExact;
  const double p =
      exact ? exact_p(earlier.size(), later.size(), ranks.u) : normal_p(earlier.size(), later.size(), ranks);
  return {ranks.u, p, exact};
}

double least_p(std::size_t n) {
  double ways = 1;  // n of 2 n
  for (std::size_t i = 1; i <= n; ++i) ways *= static_cast<double>(n + i) / static_cast<double>(i);
  return 1 / ways;
}

}  // namespace fusebench::compare
