#include "eval/metrics/mesh_error/transform_file.hpp"

#include <fmt/format.h>

#include <Eigen/LU>
#include <array>
#include <cmath>
#include <span>
#include <vector>

#include "core/base/io/stamped_rows.hpp"
#include "core/base/io/text_table.hpp"
#include "core/base/trajectory/trajectory_rows.hpp"
#include "eval/metrics/trajectory_files/nearest_rotation.hpp"

namespace fusebench::mesh_error {

namespace {

constexpr std::size_t kRow = 4;
constexpr std::size_t kWithLastRow = 16;
constexpr std::size_t kWithout = 12;

Result<std::vector<double>> numbers_of(const std::filesystem::path& file) {
  std::vector<double> numbers;
  const Result<void> done = io::for_each_row(
      file, "m11 m12 m13 m14 [m21 m22 m23 m24 m31 m32 m33 m34 m41 m42 m43 m44]",
      [&](const io::TextTable& table) -> Result<void> {
        std::array<double, kWithLastRow> row{};
        const std::size_t columns = table.has(kRow) ? kWithLastRow : kRow;
        if (auto read = table.numbers(0, std::span(row).first(columns)); !read) return read;
        numbers.insert(numbers.end(), row.begin(), row.begin() + static_cast<std::ptrdiff_t>(columns));
        return {};
      });
  if (!done) return tl::unexpected(done.error());
  return numbers;
}

}  // namespace

Result<SE3> read_transform(const std::filesystem::path& file) {
  constexpr double kNoRotation = 1e-2;
  const auto numbers = numbers_of(file);
  if (!numbers) return tl::unexpected(numbers.error());
  const auto refuse = [&](const std::string& what) {
    return fail(ErrorCode::data_corrupt, fmt::format("{}: {}", file.string(), what),
                "expected a rigid 4x4 transform, row by row, in metres");
  };
  if (numbers->size() != kWithLastRow && numbers->size() != kWithout)
    return refuse(fmt::format("{} numbers (expected 16, or 12 without the last row)", numbers->size()));
  if (numbers->size() == kWithLastRow) {
    constexpr std::array<double, 4> kLastRow = {0, 0, 0, 1};
    for (std::size_t i = 0; i < kLastRow.size(); ++i) {
      if (std::abs((*numbers)[kWithout + i] - kLastRow[i]) > 1e-9)
        return refuse("the last row is not 0 0 0 1: is the matrix written column by column?");
    }
  }
  const Eigen::Map<const Eigen::Matrix<double, 3, 4, Eigen::RowMajor>> T(numbers->data());
  const trajectory_files::NearestRotation rotation = trajectory_files::nearest_rotation(T.leftCols<3>());
  if (!(rotation.deviation < kNoRotation)) {
    return refuse(fmt::format("the 3x3 part is no rotation (determinant {:g}, R^T R off identity by {:.2g})",
                              T.leftCols<3>().determinant(), rotation.deviation));
  }
  const Vector3d translation_m = T.col(3);
  if (const auto fault = trajectory::coordinate_fault("translation", translation_m)) return refuse(*fault);
  return SE3{Quaterniond(rotation.R).normalized(), translation_m};
}

}  // namespace fusebench::mesh_error
