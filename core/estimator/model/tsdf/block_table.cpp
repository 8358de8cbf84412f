#include "core/estimator/model/tsdf/block_table.hpp"

#include <algorithm>
#include <utility>

namespace fusebench::tsdf {

bool BlockTable::insert(const BlockIndex& index) {
  if (2 * (size_ + 1) > entries_.size()) grow();
  Entry& entry = entries_[probe(index)];
  if (entry.slot >= 0) return false;
  entry = {index.x(), index.y(), index.z(), static_cast<std::int32_t>(size_++)};
  return true;
}

void BlockTable::clear() {
  std::fill(entries_.begin(), entries_.end(), Entry{});
  size_ = 0;
}

void BlockTable::grow() {
  const std::vector<Entry> old = std::exchange(entries_, std::vector<Entry>(2 * entries_.size()));
  for (const Entry& entry : old) {
    if (entry.slot >= 0) entries_[probe({entry.x, entry.y, entry.z})] = entry;
  }
}

}  // namespace fusebench::tsdf
