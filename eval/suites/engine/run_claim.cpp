#include "eval/suites/engine/run_claim.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <string_view>
#include <system_error>
#include <utility>

#include "eval/record/run_files/found_runs.hpp"

namespace fusebench::engine {

namespace fs = std::filesystem;

namespace {

/// As claim_name() makes them.
bool is_claim(std::string_view name) {
  constexpr std::size_t kIdentity = 32;
  constexpr std::string_view kDigits = "0123456789";
  return name.size() > kIdentity + 1 && name[kIdentity] == '-' &&
         name.substr(0, kIdentity).find_first_not_of("0123456789abcdef") == std::string_view::npos &&
         name.substr(kIdentity + 1).find_first_not_of(kDigits) == std::string_view::npos;
}

}  // namespace

fs::path engine_folder(const fs::path& out) { return out / run_files::kEngineFolderName; }

std::string claim_name(const std::string& run_id, int repetition) {
  return fmt::format("{}-{}", run_id, repetition);
}

Result<std::optional<RunClaim>> RunClaim::take(const fs::path& out, const std::string& name) {
  const fs::path folder = engine_folder(out) / "claims";
  std::error_code error;
  fs::create_directories(folder, error);
  const fs::path file = folder / name;
  while (true) {
    const int descriptor = open(file.c_str(), O_RDWR | O_CREAT | O_NOFOLLOW | O_CLOEXEC, 0666);
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
    const bool same = fstat(descriptor, &ours) == 0 && lstat(file.c_str(), &there) == 0 &&
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

std::vector<fs::path> remove_free_claims(const fs::path& out, bool only_look) {
  std::vector<fs::path> free;
  std::error_code error;
  for (fs::directory_iterator entry(engine_folder(out) / "claims", error), end; !error && entry != end;
       entry.increment(error)) {
    if (!is_claim(entry->path().filename().string())) continue;
    const int descriptor = open(entry->path().c_str(), O_RDWR | O_CLOEXEC);
    if (descriptor < 0) continue;
    std::error_code ignored;
    if (flock(descriptor, LOCK_EX | LOCK_NB) == 0 && (only_look || fs::remove(entry->path(), ignored)))
      free.push_back(entry->path());
    close(descriptor);
  }
  return free;
}

}  // namespace fusebench::engine
