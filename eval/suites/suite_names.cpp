#include "eval/suites/suite_names.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string>
#include <system_error>

#include "core/base/nearest_name.hpp"

namespace fusebench::suites {

namespace fs = std::filesystem;

namespace {

/// The folders at and above which configs/ is looked for; of the program the file.
std::array<fs::path, 2> places_of_configs() {
  std::error_code ignored;
  return {fs::current_path(ignored), fs::read_symlink("/proc/self/exe", ignored)};
}

}  // namespace

Result<std::vector<fs::path>> suite_files(const fs::path& configs) {
  if (configs.empty()) {
    const auto [here, program] = places_of_configs();
    return fail(ErrorCode::data_missing,
                fmt::format("no suites are found: there is no configs/suites/ and no "
                            "share/fusebench/configs/suites/ in {} or above it, nor above the program {}",
                            here.string(), program.string()),
                "start in a checkout of fusebench, or name the folder that holds suites/ with --configs; a "
                "suite is also given by its file");
  }
  std::error_code error;
  std::vector<fs::path> files;
  const fs::path folder = configs / "suites";
  for (fs::directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error)) {
    if (entry->path().extension() == ".toml") files.push_back(entry->path());
  }
  if (error) {
    return fail(ErrorCode::data_missing,
                fmt::format("{}: cannot be listed: {}", folder.string(), error.message()),
                "--configs names the folder that holds suites/");
  }
  std::ranges::sort(files);
  return files;
}

fs::path shipped_configs() {
  std::error_code ignored;
  if (fs::is_directory("configs/suites", ignored)) return "configs";  // as people would write it
  for (const fs::path& start : places_of_configs()) {
    for (fs::path folder = start; folder.has_relative_path(); folder = folder.parent_path()) {
      for (const fs::path& configs : {folder / "configs", folder / "share" / "fusebench" / "configs"}) {
        if (fs::is_directory(configs / "suites", ignored)) return configs;
      }
    }
  }
  return {};
}

Result<fs::path> find_suite(const fs::path& name, const fs::path& configs) {
  std::error_code ignored;
  const bool plain = !name.has_parent_path() && !name.has_extension();
  if (fs::is_regular_file(name, ignored) || !plain) return name;
  const auto files = configs.empty() ? Result<std::vector<fs::path>>() : suite_files(configs);
  std::vector<std::string> names;
  if (files) {
    for (const fs::path& file : *files) {
      if (file.stem() == name) return file;
      names.push_back(file.stem().string());
    }
  }
  return fail(
      ErrorCode::data_missing,
      fmt::format("no suite '{}'{}", name.string(), nearest_hint(name.string(), names)),
      "`fusebench list suites` lists those that are found by name; any other one is given by its file");
}

}  // namespace fusebench::suites
