#include "core/base/trajectory/association.hpp"

#include <algorithm>
#include <functional>
#include <limits>
#include <queue>
#include <tuple>
#include <utility>

namespace fusebench::trajectory {

namespace {

constexpr std::size_t kNone = std::numeric_limits<std::size_t>::max();

/// The stamp of an entry of the first list on the clock of the second; clamped to what 64 bits hold.
std::int64_t on_second_clock(std::int64_t first_ns, std::int64_t offset_ns) {
  std::int64_t wanted_ns = 0;
  if (!__builtin_sub_overflow(first_ns, offset_ns, &wanted_ns)) return wanted_ns;
  return offset_ns < 0 ? std::numeric_limits<std::int64_t>::max() : std::numeric_limits<std::int64_t>::min();
}

/// |a - b|, which can be more than a signed number holds.
std::uint64_t distance_ns(std::int64_t a, std::int64_t b) {
  const auto later = static_cast<std::uint64_t>(std::max(a, b));
  return later - static_cast<std::uint64_t>(std::min(a, b));
}

/// Entries of one list and one stamp that have no partner yet: those of the indices [next, end). Nodes of a
/// linked list in the order of time.
struct Node {
  std::int64_t time_ns = 0;
  std::size_t next = 0;
  std::size_t end = 0;
  std::size_t before = kNone;
  std::size_t after = kNone;
  bool of_first = false;
};

/// The closest pair of entries of two neighbouring nodes when it was queued.
struct Candidate {
  std::uint64_t difference_ns = 0;
  std::size_t first = 0;
  std::size_t second = 0;
  std::size_t left = 0;  ///< node; the other one is behind it

  bool operator>(const Candidate& other) const {
    return std::tie(difference_ns, first, second) > std::tie(other.difference_ns, other.first, other.second);
  }
};

/// Takes the closest pair until none is left.
//
// Entries of equal stamps are paired when the list is made, so that all entries of a stamp are of one side.
// Of the pairs that are left, a closest one has no entry between its stamps: that entry would be closer to
// one of the two. So its nodes are neighbours, and of equally close pairs of two nodes the first entries of
// both come first. The closest pair of two neighbours is queued when they become neighbours, and again when
// one of its entries is taken, so that the least of the queue that still holds is the least of all pairs.
// Each pair that is taken queues at most four candidates: O(n log n) time, O(n) memory.
class ClosestPairs {
 public:
  ClosestPairs(std::span<const std::int64_t> first_ns, std::span<const std::int64_t> second_ns,
               std::uint64_t limit_ns, std::int64_t offset_ns);

  std::vector<AssociatedPair> take_all();

 private:
  void add(std::int64_t time_ns, std::size_t next, std::size_t end, bool of_first);
  void queue(std::size_t left);
  void remove(std::size_t node);
  [[nodiscard]] bool still_holds(const Candidate& candidate) const;

  std::uint64_t limit_ns_;
  std::vector<Node> nodes_;
  std::vector<AssociatedPair> pairs_;
  std::priority_queue<Candidate, std::vector<Candidate>, std::greater<>> closest_;
};

ClosestPairs::ClosestPairs(std::span<const std::int64_t> first_ns, std::span<const std::int64_t> second_ns,
                           std::uint64_t limit_ns, std::int64_t offset_ns)
    : limit_ns_(limit_ns) {
  std::size_t a = 0;
  std::size_t b = 0;
  while (a < first_ns.size() || b < second_ns.size()) {
    const bool first_is_next =
        b == second_ns.size() ||
        (a < first_ns.size() && on_second_clock(first_ns[a], offset_ns) <= second_ns[b]);
    const std::int64_t time_ns = first_is_next ? on_second_clock(first_ns[a], offset_ns) : second_ns[b];
    std::size_t a_end = a;
    while (a_end < first_ns.size() && on_second_clock(first_ns[a_end], offset_ns) == time_ns) ++a_end;
    std::size_t b_end = b;
    while (b_end < second_ns.size() && second_ns[b_end] == time_ns) ++b_end;
    while (a < a_end && b < b_end) pairs_.push_back({a++, b++});
    if (a < a_end) add(time_ns, a, a_end, true);
    if (b < b_end) add(time_ns, b, b_end, false);
    a = a_end;
    b = b_end;
  }
  for (std::size_t left = 0; left < nodes_.size(); ++left) queue(left);
}

void ClosestPairs::add(std::int64_t time_ns, std::size_t next, std::size_t end, bool of_first) {
  const std::size_t node = nodes_.size();
  nodes_.push_back({time_ns, next, end, node == 0 ? kNone : node - 1, kNone, of_first});
  if (node > 0) nodes_[node - 1].after = node;
}

/// Queues the closest pair of a node and the one behind it, if they are of different lists.
void ClosestPairs::queue(std::size_t left) {
  const Node& node = nodes_[left];
  if (node.after == kNone) return;
  const Node& behind = nodes_[node.after];
  if (node.of_first == behind.of_first) return;
  const std::uint64_t difference_ns = distance_ns(node.time_ns, behind.time_ns);
  if (difference_ns >= limit_ns_) return;
  closest_.push(node.of_first ? Candidate{difference_ns, node.next, behind.next, left}
                              : Candidate{difference_ns, behind.next, node.next, left});
}

void ClosestPairs::remove(std::size_t node) {
  const auto [before, after] = std::pair(nodes_[node].before, nodes_[node].after);
  if (before != kNone) nodes_[before].after = after;
  if (after != kNone) nodes_[after].before = before;
  if (before != kNone) queue(before);
}

bool ClosestPairs::still_holds(const Candidate& candidate) const {
  const Node& left = nodes_[candidate.left];
  if (left.next == left.end || left.after == kNone) return false;
  const Node& right = nodes_[left.after];
  if (left.of_first == right.of_first) return false;
  const auto [first, second] =
      left.of_first ? std::pair(left.next, right.next) : std::pair(right.next, left.next);
  return first == candidate.first && second == candidate.second;
}

std::vector<AssociatedPair> ClosestPairs::take_all() {
  while (!closest_.empty()) {
    const Candidate candidate = closest_.top();
    closest_.pop();
    if (!still_holds(candidate)) continue;
    pairs_.push_back({candidate.first, candidate.second});
    const std::size_t left = candidate.left;
    const std::size_t right = nodes_[left].after;
    const bool left_is_empty = ++nodes_[left].next == nodes_[left].end;
    const bool right_is_empty = ++nodes_[right].next == nodes_[right].end;
    if (right_is_empty) remove(right);
    if (left_is_empty) remove(left);
    if (!right_is_empty) queue(right);
    if (left_is_empty) continue;
    queue(left);
    if (nodes_[left].before != kNone) queue(nodes_[left].before);
  }
  std::ranges::sort(pairs_, {}, &AssociatedPair::first);
  return std::move(pairs_);
}

}  // namespace

std::vector<AssociatedPair> associate(std::span<const std::int64_t> first_ns,
                                      std::span<const std::int64_t> second_ns, std::int64_t max_difference_ns,
                                      std::int64_t offset_ns) {
  if (max_difference_ns <= 0) return {};
  return ClosestPairs(first_ns, second_ns, static_cast<std::uint64_t>(max_difference_ns), offset_ns)
      .take_all();
}

}  // namespace fusebench::trajectory
