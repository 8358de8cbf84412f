#include "core/staged_folder.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <system_error>
#include <utility>

namespace fusebench {

namespace fs = std::filesystem;

namespace {

/// "<name><suffix of this process>" beside a path; the dot keeps it out of listings.
fs::path hidden_sibling(const fs::path& path, std::string_view suffix) {
  return path.parent_path() / fmt::format(".{}.{}.{}", path.filename().string(), getpid(), suffix);
}

tl::unexpected<Error> io_error(const fs::path& path, const std::error_code& error) {
  return fail(ErrorCode::io, fmt::format("{}: cannot be written: {}", path.string(), error.message()),
              "choose another folder with --out");
}

}  // namespace

Result<StagedFolder> StagedFolder::create(const fs::path& final_folder) {
  StagedFolder folder;
  folder.final_ = final_folder;
  std::error_code error;
  std::vector<fs::path> missing;
  for (fs::path parent = final_folder.parent_path(); !parent.empty() && !fs::exists(parent, error);
       parent = parent.parent_path()) {
    missing.push_back(parent);
  }
  std::reverse(missing.begin(), missing.end());
  for (const fs::path& parent : missing) {
    // Another process may have made it in the meantime: that is not an error, and it is not ours to remove.
    if (fs::create_directory(parent, error)) folder.created_.push_back(parent);
    if (error) return io_error(parent, error);
  }
  const fs::path temporary = hidden_sibling(final_folder, "tmp");
  fs::remove_all(temporary, error);
  if (!fs::create_directory(temporary, error)) return io_error(temporary, error);
  folder.temporary_ = temporary;
  return folder;
}

StagedFolder::StagedFolder(StagedFolder&& other) noexcept
    : final_(std::move(other.final_)),
      temporary_(std::exchange(other.temporary_, {})),
      created_(std::exchange(other.created_, {})) {}

StagedFolder::~StagedFolder() {
  std::error_code ignored;
  if (!temporary_.empty()) fs::remove_all(temporary_, ignored);
  // Innermost first; one that holds something else stays.
  for (auto parent = created_.rbegin(); parent != created_.rend(); ++parent) fs::remove(*parent, ignored);
}

Result<void> StagedFolder::write(std::string_view name, std::string_view text) const {
  std::ofstream stream(file(name), std::ios::binary);
  stream.write(text.data(), static_cast<std::streamsize>(text.size()));
  stream.close();
  if (!stream) return fail(ErrorCode::io, fmt::format("{}: cannot be written", file(name).string()));
  return {};
}

Result<void> StagedFolder::commit() {
  std::error_code error;
  const fs::path old = hidden_sibling(final_, "old");
  const bool replaces = fs::exists(final_, error);
  if (replaces) {
    fs::rename(final_, old, error);
    if (error) return io_error(final_, error);
  }
  fs::rename(temporary_, final_, error);
  if (error) {
    std::error_code ignored;
    if (replaces) fs::rename(old, final_, ignored);
    return io_error(final_, error);
  }
  temporary_.clear();
  created_.clear();
  if (replaces) fs::remove_all(old, error);
  return {};
}

}  // namespace fusebench
