// A large array that grows without a copy.
#pragma once

#include <cstddef>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <new>
#include <type_traits>
#include <utility>

namespace fusebench {
inline namespace base {

/// An array of trivial values that grows by realloc(). For large arrays the operating system remaps pages
/// instead of copying bytes, so growing costs little time and no second copy in memory. Pages that were never
/// written use no memory.
template <class T>
class GrowingArray {
  static_assert(std::is_trivially_copyable_v<T>);

 public:
  GrowingArray() = default;
  GrowingArray(const GrowingArray& other) { *this = other; }
  GrowingArray(GrowingArray&& other) noexcept { *this = std::move(other); }
  GrowingArray& operator=(const GrowingArray& other) {
    if (this == &other) return *this;
    size_ = 0;
    grow_to(other.size_);
    if (other.size_ > 0) std::memcpy(data(), other.data(), other.size_ * sizeof(T));
    return *this;
  }
  GrowingArray& operator=(GrowingArray&& other) noexcept {
    values_ = std::move(other.values_);
    size_ = std::exchange(other.size_, 0);
    capacity_ = std::exchange(other.capacity_, 0);
    return *this;
  }
  ~GrowingArray() = default;

  [[nodiscard]] std::size_t size() const { return size_; }
  [[nodiscard]] std::size_t memory_bytes() const { return capacity_ * sizeof(T); }
  [[nodiscard]] T* data() { return values_.get(); }
  [[nodiscard]] const T* data() const { return values_.get(); }

  /// Appends uninitialised values. Throws std::bad_alloc.
  void grow_to(std::size_t size) {
    if (size > capacity_) {
      const std::size_t capacity = size + size / 2;
      void* const moved = std::realloc(values_.get(), capacity * sizeof(T));
      if (moved == nullptr) throw std::bad_alloc();
      (void)values_.release();
      values_.reset(static_cast<T*>(moved));
      capacity_ = capacity;
    }
    if (size > size_) size_ = size;
  }

 private:
  struct Free {
    void operator()(T* values) const { std::free(values); }
  };
  std::unique_ptr<T[], Free> values_;
  std::size_t size_ = 0;
  std::size_t capacity_ = 0;
};

}  // namespace base
}  // namespace fusebench
