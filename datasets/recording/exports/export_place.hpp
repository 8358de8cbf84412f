// Where an export is written: all of it appears at once, or nothing.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/base/error.hpp"
#include "core/base/io/staged_folder.hpp"

namespace fusebench::exports {

using TextFile = std::pair<std::string, std::string>;  ///< name and content

/// A folder, or files beside each other: filled under a temporary name beside the destination, and moved
/// there by commit(). Removes everything that it created unless commit() succeeded.
class ExportPlace {
 public:
  enum class Kind { folder, files };

  /// out: the folder, or the first of the files. Nothing that is there is replaced. Errors: usage (it exists,
  /// or a file without a name), io.
  [[nodiscard]] static Result<ExportPlace> create(const std::filesystem::path& out, Kind kind);

  /// The last name of `out`.
  [[nodiscard]] const std::string& name() const { return name_; }
  /// A name like that of `out` with another ending: "room.klg" and "calibration.txt" give
  /// "room.calibration.txt".
  [[nodiscard]] std::string beside(std::string_view ending) const;

  /// Where to write a file; names may have folders in them, which create_folders() makes.
  [[nodiscard]] std::filesystem::path file(std::string_view name) const { return staged_.file(name); }
  /// Errors: io.
  [[nodiscard]] Result<void> create_folders(const std::vector<std::string>& names) const;
  /// In their order, up to the first error.
  [[nodiscard]] Result<void> write(const std::vector<TextFile>& files) const;
  /// Errors: io; usage (one of the files exists).
  [[nodiscard]] Result<void> commit();

 private:
  ExportPlace(io::StagedFolder staged, std::filesystem::path out, Kind kind);
  [[nodiscard]] Result<void> move_files() const;

  io::StagedFolder staged_;
  std::filesystem::path out_;
  std::string name_;
  Kind kind_;
};

/// The error io of a file, which names it.
[[nodiscard]] tl::unexpected<Error> cannot_be_written(const std::filesystem::path& file,
                                                      std::string_view reason = {});

}  // namespace fusebench::exports
