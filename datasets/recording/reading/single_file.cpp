#include "datasets/recording/reading/single_file.hpp"

#include <system_error>

namespace fusebench::reading {

std::optional<std::filesystem::path> file_with_ending(const std::filesystem::path& place,
                                                      std::string_view ending) {
  const auto fits = [&](const std::filesystem::path& file) {
    std::error_code ignored;
    return file.extension() == ending && std::filesystem::is_regular_file(file, ignored);
  };
  if (fits(place)) return place;
  std::optional<std::filesystem::path> found;
  std::error_code ignored;
  for (const auto& entry : std::filesystem::directory_iterator(place, ignored)) {
    if (!fits(entry.path())) continue;
    if (found) return std::nullopt;
    found = entry.path();
  }
  return found;
}

}  // namespace fusebench::reading
