// Selection of the smallest candidates (most similar or nearest).
#pragma once

#include <algorithm>
#include <cstddef>
#include <utility>
#include <vector>

namespace fusebench::places {

/// The `count` candidates with the smallest numbers, ascending; stable for equal ones.
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
