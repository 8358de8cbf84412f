// Deterministic parallel loops. The chunk size does not depend on the number of threads, each chunk writes
// its own slot, and slots are reduced in index order. Results do not depend on the number of threads.
#pragma once

#include <algorithm>
#include <cstddef>
#include <functional>
#include <memory>
#include <vector>

namespace fusebench {
inline namespace base {

/// A fixed number of threads that run chunks. Not copyable; pass by reference.
class Workers {
 public:
  /// threads >= 1.
  explicit Workers(int threads);
  ~Workers();
  Workers(const Workers&) = delete;
  Workers& operator=(const Workers&) = delete;

  [[nodiscard]] int threads() const { return threads_; }

  /// Calls body(begin, end) for the chunks of [0, count), in any order and concurrently. Rethrows an
  /// exception of the body to the caller.
  void for_chunks(std::size_t count, std::size_t chunk_size,
                  const std::function<void(std::size_t begin, std::size_t end)>& body) const;

  /// Calls fill(row) for the rows 0 to count - 1, in chunks of rows.
  template <class Fill>
  void for_rows(int count, const Fill& fill) const {
    constexpr std::size_t kRowsPerChunk = 16;
    for_chunks(static_cast<std::size_t>(count), kRowsPerChunk, [&](std::size_t begin, std::size_t end) {
      for (auto row = static_cast<int>(begin); row < static_cast<int>(end); ++row) fill(row);
    });
  }

  /// Maps each chunk to a value, in any order, and returns the values in chunk order.
  template <class Value, class Map>
  [[nodiscard]] std::vector<Value> map_chunks(std::size_t count, std::size_t chunk_size,
                                              const Map& map) const {
    std::vector<Value> values((count + chunk_size - 1) / chunk_size);
    for_chunks(count, chunk_size,
               [&](std::size_t begin, std::size_t end) { values[begin / chunk_size] = map(begin, end); });
    return values;
  }

 private:
  struct Arena;
  int threads_;
  std::unique_ptr<Arena> arena_;
};

}  // namespace base
}  // namespace fusebench
