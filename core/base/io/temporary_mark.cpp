#include "core/base/io/temporary_mark.hpp"

#include <dirent.h>
#include <fcntl.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cstdlib>
#include <cstring>
#include <string>
#include <utility>

namespace fusebench::io {

namespace {

/// The kind's letter and the path, or null. A signal handler can reach nothing but static storage.
using Slot = std::atomic<char*>;
static_assert(Slot::is_always_lock_free, "a signal handler may only touch lock-free atomics");

std::array<Slot, kMostMarks>& slots() {
  static std::array<Slot, kMostMarks> marked{};
  return marked;
}

bool is_dots(const char* name) { return std::strcmp(name, ".") == 0 || std::strcmp(name, "..") == 0; }

/// Without allocating memory: the signal may have interrupted malloc(). Links are removed, not followed.
void remove_tree(int parent, const char* name) noexcept {
  const int folder = openat(parent, name, O_RDONLY | O_DIRECTORY | O_NOFOLLOW | O_CLOEXEC);
  if (folder < 0) {
    unlinkat(parent, name, 0);
    return;
  }
  alignas(dirent64) std::array<char, 2048> entries;
  while (true) {
    const ssize_t size = getdents64(folder, entries.data(), entries.size());
    if (size <= 0) break;
    for (ssize_t at = 0; at < size;) {
      const auto* const entry = reinterpret_cast<const dirent64*>(entries.data() + at);
      if (!is_dots(entry->d_name)) remove_tree(folder, entry->d_name);
      at += entry->d_reclen;
    }
  }
  close(folder);
  unlinkat(parent, name, AT_REMOVEDIR);
}

/// Other threads may be writing into the tree meanwhile.
constexpr int kPasses = 8;

}  // namespace

TemporaryMark::TemporaryMark(Kind kind, const std::filesystem::path& path) {
  char* const text = strdup((static_cast<char>(kind) + path.string()).c_str());
  if (text == nullptr) return;
  for (std::size_t slot = 0; slot < slots().size(); ++slot) {
    char* free_slot = nullptr;
    if (!slots()[slot].compare_exchange_strong(free_slot, text)) continue;
    slot_ = static_cast<int>(slot);
    return;
  }
  std::free(text);
}

TemporaryMark::TemporaryMark(TemporaryMark&& other) noexcept : slot_(std::exchange(other.slot_, -1)) {}

TemporaryMark& TemporaryMark::operator=(TemporaryMark&& other) noexcept {
  if (this == &other) return *this;
  release();
  slot_ = std::exchange(other.slot_, -1);
  return *this;
}

TemporaryMark::~TemporaryMark() { release(); }

/// A handler that reads the text has taken it out of its slot before: who finds it there frees it.
void TemporaryMark::release() noexcept {
  if (slot_ >= 0) std::free(slots()[static_cast<std::size_t>(slot_)].exchange(nullptr));
  slot_ = -1;
}

void remove_marked_places() noexcept {
  std::array<char*, kMostMarks> texts;
  for (std::size_t i = 0; i < texts.size(); ++i) texts[i] = slots()[i].exchange(nullptr);
  for (int pass = 0; pass < kPasses; ++pass) {
    for (char* const text : texts) {
      if (text == nullptr) continue;
      const auto kind = static_cast<TemporaryMark::Kind>(text[0]);
      if (kind == TemporaryMark::Kind::file) unlink(text + 1);
      if (kind == TemporaryMark::Kind::tree) remove_tree(AT_FDCWD, text + 1);
    }
    for (char* const text : texts)
      if (text != nullptr && text[0] == static_cast<char>(TemporaryMark::Kind::empty_folder)) rmdir(text + 1);
  }
}

}  // namespace fusebench::io
