#include "datasets/recording/reading/image_list.hpp"

#include <fmt/format.h>

#include <system_error>

#include "core/base/io/stamped_rows.hpp"
#include "core/base/printable.hpp"

namespace fusebench::reading {

namespace {

constexpr std::string_view kListColumns = "timestamp filename ...";

/// Adds the image of each row to `listed`.
io::StampedRow listing_of(const std::filesystem::path& list, const std::filesystem::path& images,
                          std::vector<ListedImage>& listed) {
  return [list, images, &listed](const io::TextTable& table, std::int64_t time_ns) -> Result<void> {
    if (auto inside = check_stays_inside(table, table.text(1), images); !inside) return inside;
    const std::filesystem::path file = images / table.text(1);
    std::error_code ignored;
    if (!std::filesystem::is_regular_file(file, ignored)) {
      return fail(ErrorCode::data_missing,
                  fmt::format("{}:{}: image {} does not exist", list.string(), table.line(),
                              printable(table.text(1), 200)),
                  fmt::format("unpack the whole recording; names are relative to {}",
                              images == list.parent_path() ? "the list's folder" : images.string()));
    }
    listed.push_back({time_ns, file});
    return {};
  };
}

}  // namespace

Result<void> check_stays_inside(const io::TextTable& table, const std::filesystem::path& name,
                                const std::filesystem::path& recording) {
  namespace fs = std::filesystem;
  std::error_code ignored;
  const fs::path folder = fs::absolute(recording / "x", ignored).lexically_normal().parent_path();
  const fs::path way = (folder / name).lexically_normal().lexically_relative(folder);
  if (!way.empty() && *way.begin() != "..") return {};
  return table.fail_here(
      fmt::format("image {} is outside of {}", printable(name.string(), 200), recording.string()),
      "a recording names what lies in its folder: move the images there, or make a link");
}

Result<std::vector<ListedImage>> read_image_list(const std::filesystem::path& list,
                                                 const std::filesystem::path& images, io::TimeUnit unit,
                                                 std::vector<std::string>& warnings) {
  std::vector<ListedImage> listed;
  const Result<void> done = io::for_each_stamped_row(list, kListColumns, io::TimeOrder::increasing,
                                                     listing_of(list, images, listed), unit, &warnings);
  if (!done) return tl::unexpected(done.error());
  return listed;
}

Result<std::vector<ListedImage>> read_image_list(const std::filesystem::path& list,
                                                 std::vector<std::string>& warnings) {
  std::vector<ListedImage> listed;
  const Result<void> done = io::for_each_stamped_row(list, kListColumns, io::TimeOrder::increasing,
                                                     listing_of(list, list.parent_path(), listed), warnings);
  if (!done) return tl::unexpected(done.error());
  return listed;
}

}  // namespace fusebench::reading
