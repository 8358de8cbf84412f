#include "datasets/simulator/write_folder.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <system_error>
#include <utility>

namespace fusebench {

namespace fs = std::filesystem;

namespace {

tl::unexpected<Error> io_error(const fs::path& path, const std::error_code& error) {
  return fail(ErrorCode::io, fmt::format("{}: cannot be written: {}", path.string(), error.message()),
              "choose another folder");
}

}  // namespace

StagedFolder::StagedFolder(fs::path final_folder) : final_(std::move(final_folder)) {}

StagedFolder::~StagedFolder() {
  std::error_code ignored;
  if (!staging_.empty()) fs::remove_all(staging_, ignored);
}

Result<void> StagedFolder::create() {
  const fs::path parent = final_.parent_path();
  const fs::path staging = parent / fmt::format(".{}.{}.tmp", final_.filename().string(), getpid());
  std::error_code error;
  if (!parent.empty()) fs::create_directories(parent, error);
  if (!error) fs::remove_all(staging, error);
  if (!error) fs::create_directory(staging, error);
  if (error) return io_error(staging, error);
  staging_ = staging;
  return {};
}

Result<void> StagedFolder::commit() {
  std::error_code error;
  fs::rename(staging_, final_, error);
  if (error) return io_error(final_, error);
  staging_.clear();
  return {};
}

}  // namespace fusebench
