#include "eval/engine/run_claim.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <system_error>
#include <utility>

namespace fusebench {

namespace fs = std::filesystem;

fs::path engine_folder(const fs::path& out) { return out / ".fusebench"; }

Result<std::optional<RunClaim>> RunClaim::take(const fs::path& out, const std::string& name) {
  const fs::path folder = engine_folder(out) / "claims";
  std::error_code error;
  fs::create_directories(folder, error);
  const fs::path file = folder / name;
  while (true) {
    const int descriptor = open(file.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666);
    if (descriptor < 0) {
      return fail(ErrorCode::io,
                  fmt::format("{}: cannot be written: {}", file.string(), std::strerror(errno)),
                  "runs that are finished are kept; the same command goes on when the folder can be written");
    }
    if (flock(descriptor, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK) {
      close(descriptor);
      return std::optional<RunClaim>();
    }
    // Its last holder may have removed the file between our opening and locking it.
    struct stat ours {};
    struct stat there {};
    const bool same = fstat(descriptor, &ours) == 0 && stat(file.c_str(), &there) == 0 &&
                      ours.st_ino == there.st_ino && ours.st_dev == there.st_dev;
    if (same) return std::optional<RunClaim>(RunClaim(file, descriptor));
    close(descriptor);
  }
}

RunClaim::RunClaim(RunClaim&& other) noexcept
    : file_(std::move(other.file_)), descriptor_(std::exchange(other.descriptor_, -1)) {}

RunClaim::~RunClaim() {
  if (descriptor_ < 0) return;
  std::error_code ignored;
  fs::remove(file_, ignored);
  close(descriptor_);
}

std::size_t remove_free_claims(const fs::path& out, bool only_count) {
  std::size_t count = 0;
  std::error_code error;
  for (fs::directory_iterator entry(engine_folder(out) / "claims", error), end; !error && entry != end;
       entry.increment(error)) {
    const int descriptor = open(entry->path().c_str(), O_RDWR | O_CLOEXEC);
    if (descriptor < 0) continue;
    std::error_code ignored;
    if (flock(descriptor, LOCK_EX | LOCK_NB) == 0 && (only_count || fs::remove(entry->path(), ignored)))
      ++count;
    close(descriptor);
  }
  return count;
}

}  // namespace fusebench
