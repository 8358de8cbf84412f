#include "datasets/recording/reading/text_matrix.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/base/io/row_text.hpp"
#include "core/base/io/text_table.hpp"
#include "datasets/calibration/rig_calibration.hpp"

namespace fusebench::reading {

namespace {

constexpr double kMaxPixels = 1e6;

Result<void> append_row(const io::TextTable& table, std::size_t columns, std::vector<double>& values) {
  for (std::size_t column = 0; column < columns; ++column) {
    if (io::is_missing(table.text(column)) || io::is_infinite(table.text(column))) {
      values.push_back(std::numeric_limits<double>::quiet_NaN());
      continue;
    }
    const auto number = table.number(column);
    if (!number) return tl::unexpected(number.error());
    values.push_back(*number);
  }
  return {};
}

}  // namespace

Result<std::vector<double>> read_matrix(const std::filesystem::path& file, std::size_t rows,
                                        std::size_t columns) {
  std::string names;
  for (std::size_t column = 1; column <= columns; ++column)
    names += fmt::format("{}m{}", names.empty() ? "" : " ", column);
  auto table = io::TextTable::open(file, names);
  if (!table) return tl::unexpected(table.error());
  std::vector<double> values;
  while (true) {
    const auto got = table->next();
    if (!got) return tl::unexpected(got.error());
    if (!*got) break;
    if (values.size() == rows * columns)
      return table->fail_here(fmt::format("a row more than the {} of a {}x{} matrix", rows, rows, columns));
    if (const auto read = append_row(*table, columns, values); !read) return tl::unexpected(read.error());
  }
  if (values.size() == rows * columns) return values;
  return fail(ErrorCode::data_corrupt,
              fmt::format("{}: has {} rows of the {} of a {}x{} matrix", file.string(),
                          values.size() / columns, rows, rows, columns));
}

Result<std::optional<SE3>> read_pose_matrix(const std::filesystem::path& file) {
  const auto values = read_matrix(file, 4, 4);
  if (!values) return tl::unexpected(values.error());
  if (!std::ranges::all_of(*values, [](double value) { return std::isfinite(value); })) return std::nullopt;
  const auto pose = calibration::rigid_transform(std::span(*values).first<16>());
  if (pose) return std::optional<SE3>(*pose);
  return fail(ErrorCode::data_corrupt, fmt::format("{}: the pose is no rigid transform ({})", file.string(),
                                                   calibration::kRigidTransformRule));
}

Result<PinholeCamera> camera_of_matrix(std::span<const double> K, const std::string& place) {
  const auto inside = [](double value) { return std::abs(value) <= kMaxPixels; };
  const bool upper = K.size() == 9 && K[1] == 0 && K[3] == 0 && K[6] == 0 && K[7] == 0 && K[8] == 1;
  if (upper && K[0] > 0 && K[4] > 0 && std::ranges::all_of(K, inside))
    return PinholeCamera{0, 0, K[0], K[4], K[2], K[5]};
  return fail(ErrorCode::data_corrupt,
              fmt::format("{}: the camera's matrix is not [fx 0 cx; 0 fy cy; 0 0 1] with focal lengths "
                          "above 0 and numbers up to {:g} pixels",
                          place, kMaxPixels));
}

Result<PinholeCamera> read_camera_matrix(const std::filesystem::path& file) {
  return read_matrix(file, 3, 3).and_then([&](const std::vector<double>& K) {
    return camera_of_matrix(K, file.string());
  });
}

}  // namespace fusebench::reading
