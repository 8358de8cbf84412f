// The recordings that the paper and its peers report, and published calibrations: the files of
// configs/recordings/, which are part of the binary. scripts/fetch_datasets.sh reads the same files.
//
//     kind = "recording"       # or "calibration": name, title, and the tables of rig_calibration.hpp
//     name = "fr1_desk"        # the file's name, and what a command line takes
//     title = "..."            # one line
//     family = "tum"           # tum | icl_nuim | fmdataset | eth3d
//     format = "tum"           # tum | icl | zr300 | eth3d: how it is published
//     # accepted places under the data folder; it is fetched to the first
//     folders = ["rgbd_dataset_freiburg1_desk"]
//     page = "https://..."     # who publishes it
//     licence = "CC BY 4.0"
//     # a camera preset, or the name of a calibration of this folder, or neither if it has its own
//     camera = "freiburg1"
//     download = ["https://..."]   # official archives, or
//     download_note = "..."        # how to get it by hand
//     archive_bytes = 344011403    # these two only with a single archive
//     archive_sha256 = "..."
//     # expected counts; a comment says where each comes from, and one without a source is left out
//     color_images = 613
//     depth_images = 595
//     frames = 600             # pairs, where the recording lists them
//     duration_s = 23.4
//     unverified = ["licence"] # keys whose value no source confirmed
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/error.hpp"
#include "datasets/calibration/rig_calibration.hpp"

namespace fusebench::calibration {

/// One recording of the catalogue; empty texts and absent numbers are not known.
struct CatalogueEntry {
  std::string name;
  std::string title;
  std::string family;
  std::string format;
  std::vector<std::string> folders;  ///< relative to the data folder; at least one
  std::string page;
  std::string licence;
  std::string camera;       ///< name of a camera preset
  std::string calibration;  ///< name of a calibration, see catalogue_calibration
  std::vector<std::string> downloads;
  std::string download_note;
  std::optional<std::int64_t> archive_bytes;
  std::string archive_sha256;  ///< 64 lower-case hexadecimal digits
  std::optional<std::int64_t> color_images;
  std::optional<std::int64_t> depth_images;
  std::optional<std::int64_t> frames;  ///< pairs that the recording lists
  std::optional<double> duration_s;
  std::vector<std::string> unverified;
};

/// Reads one file. Error configuration, with file:line: bad syntax, an unknown or missing key, a value of the
/// wrong type.
[[nodiscard]] Result<CatalogueEntry> parse_catalogue_entry(std::string_view text, const std::string& file);

/// All recordings, by name.
[[nodiscard]] std::span<const CatalogueEntry> recording_catalogue();

/// The recording of that name; nullptr if there is none.
[[nodiscard]] const CatalogueEntry* find_catalogue_entry(std::string_view name);

/// The recording whose accepted folders end the path: "data/dorm1/dorm1_slow" is dorm1_slow. nullptr if there
/// is none.
[[nodiscard]] const CatalogueEntry* catalogue_entry_of_folder(const std::filesystem::path& folder);

/// The first accepted folder that exists under `data` (may be empty: then none does).
[[nodiscard]] std::optional<std::filesystem::path> catalogue_folder(const CatalogueEntry& entry,
                                                                    const std::filesystem::path& data);

/// A published calibration, e.g. "zr300_fmdataset". Error configuration: no such name (with the nearest).
[[nodiscard]] Result<RigCalibration> catalogue_calibration(std::string_view name);

/// One file of configs/recordings/, as it was at build time.
struct CatalogueFile {
  std::string_view name;  ///< "configs/recordings/fr1_desk.toml"
  std::string_view text;
};

/// All files, by name. Defined by a generated source (scripts/cmake/embed_toml.cmake).
[[nodiscard]] std::span<const CatalogueFile> catalogue_files();

}  // namespace fusebench::calibration
