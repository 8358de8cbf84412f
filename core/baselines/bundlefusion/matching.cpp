#include "core/baselines/bundlefusion/matching.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>

namespace fusebench::baselines::bundlefusion {

namespace {

constexpr double kMaxDistance = 0.7;
constexpr double kMaxRatio = 0.8;  // largest ratio of the nearest to the second nearest distance
constexpr std::size_t kMaxMatches = 128;

/// Cosines of the angles to the two nearest descriptors; larger is nearer.
struct Nearest {
  std::size_t index = 0;
  double first = -1;
  double second = -1;

  void offer(std::size_t candidate, double cosine) {
    if (cosine > first) {
      second = first;
      first = cosine;
      index = candidate;
    } else if (cosine > second) {
      second = cosine;
    }
  }
};

double cosine_of(const SiftDescriptor& a, const SiftDescriptor& b) {
  int product = 0;
  for (std::size_t i = 0; i < a.values.size(); ++i)
    product += static_cast<int>(a.values[i]) * static_cast<int>(b.values[i]);
  return product * a.inverse_norm * b.inverse_norm;
}

/// Distance of two unit vectors by their cosine.
double distance_of(double cosine) { return std::sqrt(std::max(0.0, 2.0 - 2.0 * cosine)); }

}  // namespace

std::vector<KeypointMatch> match_keypoints(const Keypoints& a, const Keypoints& b) {
  std::vector<Nearest> nearest_of_a(a.size());
  std::vector<Nearest> nearest_of_b(b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    for (std::size_t j = 0; j < b.size(); ++j) {
      const double cosine = cosine_of(a[i].descriptor, b[j].descriptor);
      nearest_of_a[i].offer(j, cosine);
      nearest_of_b[j].offer(i, cosine);
    }
  }
  std::vector<KeypointMatch> matches;
  for (std::size_t i = 0; i < a.size(); ++i) {
    const Nearest& nearest = nearest_of_a[i];
    const double distance = distance_of(nearest.first);
    if (b.empty() || nearest_of_b[nearest.index].index != i || distance > kMaxDistance) continue;
    if (!(distance < kMaxRatio * distance_of(nearest.second))) continue;
    matches.push_back({i, nearest.index, distance});
  }
  std::ranges::sort(matches, [](const KeypointMatch& left, const KeypointMatch& right) {
    return std::tie(left.distance, left.a) < std::tie(right.distance, right.a);
  });
  matches.resize(std::min(matches.size(), kMaxMatches));
  return matches;
}

}  // namespace fusebench::baselines::bundlefusion
