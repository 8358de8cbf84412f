// Temporary files and folders of this process, which a signal handler can remove.
#pragma once

#include <filesystem>

namespace fusebench::io {

/// Marks a path as temporary for as long as the mark lives. A process has up to kMostMarks; further ones mark
/// nothing.
class TemporaryMark {
 public:
  enum class Kind : char {
    file = 'f',
    tree = 't',          ///< a folder with all that is in it
    empty_folder = 'e',  ///< removed only if nothing is in it
  };

  TemporaryMark() = default;
  TemporaryMark(Kind kind, const std::filesystem::path& path);
  TemporaryMark(TemporaryMark&& other) noexcept;
  TemporaryMark& operator=(TemporaryMark&& other) noexcept;
  TemporaryMark(const TemporaryMark&) = delete;
  TemporaryMark& operator=(const TemporaryMark&) = delete;
  ~TemporaryMark();

 private:
  void release() noexcept;

  int slot_ = -1;  ///< -1: nothing is marked
};

inline constexpr int kMostMarks = 64;

/// Removes what is marked, in any thread at any time: for signal handlers of a process that ends.
void remove_marked_places() noexcept;

}  // namespace fusebench::io
