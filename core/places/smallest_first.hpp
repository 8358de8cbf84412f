// What is looked at of many candidates: those that are the most alike, or the nearest.
#pragma once

#include <algorithm>
#include <cstddef>
#include <utility>
#include <vector>

namespace fusebench::places {

/// The candidates with the smallest numbers, at most so many, the smallest first; of equal ones those that
/// stood first.
template <class Candidate>
[[nodiscard]] std::vector<Candidate> smallest_first(std::vector<std::pair<double, Candidate>> numbered,
                                                    std::size_t most) {
  std::ranges::stable_sort(numbered, {}, &std::pair<double, Candidate>::first);
  numbered.resize(std::min(numbered.size(), most));
  std::vector<Candidate> first;
  for (auto& [number, candidate] : numbered) first.push_back(std::move(candidate));
  return first;
}

}  // namespace fusebench::places
