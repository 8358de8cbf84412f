#include "datasets/recording/formats/rosbag/bag_file.hpp"

#include <bzlib.h>
#include <fmt/format.h>

#include <optional>
#include <utility>

#include "core/base/printable.hpp"
#include "datasets/recording/formats/rosbag/lz4_frame.hpp"
#include "datasets/recording/image_logs/file_part.hpp"
#include "datasets/recording/image_logs/little_endian.hpp"

namespace fusebench::formats::rosbag {

namespace {

using image_logs::LittleEndianReader;

constexpr std::string_view kMagic = "#ROSBAG V2.0\n";
constexpr std::uint64_t kMostChunkBytes = std::uint64_t{1} << 30;
constexpr std::int64_t kNanosecondsPerSecond = 1'000'000'000;

enum class Operation : int {
  message = 2,
  bag_header = 3,
  index = 4,
  chunk = 5,
  chunk_info = 6,
  connection = 7
};

using Fields = std::map<std::string, std::string, std::less<>>;

std::uint64_t little_endian(std::string_view bytes) {
  std::uint64_t value = 0;
  for (std::size_t i = bytes.size(); i > 0; --i)
    value = value << 8 | static_cast<unsigned char>(bytes[i - 1]);
  return value;
}

/// Nothing if the bytes are no such fields.
std::optional<Fields> fields_of(std::string_view bytes) {
  Fields fields;
  while (!bytes.empty()) {
    if (bytes.size() < 4) return std::nullopt;
    const std::uint64_t length = little_endian(bytes.substr(0, 4));
    bytes.remove_prefix(4);
    if (length > bytes.size()) return std::nullopt;
    const std::string_view field = bytes.substr(0, length);
    bytes.remove_prefix(length);
    const std::size_t equals = field.find('=');
    if (equals == std::string_view::npos) return std::nullopt;
    fields[std::string(field.substr(0, equals))] = field.substr(equals + 1);
  }
  return fields;
}

/// Nothing if there is no such field of that many bytes.
std::optional<std::uint64_t> number(const Fields& fields, std::string_view name, std::size_t bytes) {
  const auto found = fields.find(name);
  if (found == fields.end() || found->second.size() != bytes) return std::nullopt;
  return little_endian(found->second);
}

std::string text(const Fields& fields, std::string_view name) {
  const auto found = fields.find(name);
  return found == fields.end() ? std::string() : found->second;
}

/// A record within bytes; the views are into them.
struct Record {
  Fields fields;
  Operation operation{};
  std::string_view data;
};

/// Takes a record from the front; nothing if it is not whole.
std::optional<Record> take_record(std::string_view& bytes) {
  const auto take = [&]() -> std::optional<std::string_view> {
    if (bytes.size() < 4) return std::nullopt;
    const std::uint64_t length = little_endian(bytes.substr(0, 4));
    if (length > bytes.size() - 4) return std::nullopt;
    const std::string_view taken = bytes.substr(4, length);
    bytes.remove_prefix(4 + length);
    return taken;
  };
  const auto header = take();
  if (!header) return std::nullopt;
  const auto data = take();
  if (!data) return std::nullopt;
  auto fields = fields_of(*header);
  if (!fields) return std::nullopt;
  const auto operation = number(*fields, "op", 1);
  if (!operation) return std::nullopt;
  return Record{std::move(*fields), static_cast<Operation>(*operation), *data};
}

/// Nothing if the bytes are damaged.
std::optional<std::string> decompressed(std::string stored, const MessagePlace& chunk) {
  if (chunk.compression == "none" && stored.size() == chunk.chunk_size) return stored;
  if (chunk.compression == "lz4") return lz4_content(stored, chunk.chunk_size);
  if (chunk.compression != "bz2") return std::nullopt;
  // bzip2 makes at most about 45 MB of 900 bytes; a claim beyond is damage, and not allocated.
  if (chunk.chunk_size / 100'000 > stored.size()) return std::nullopt;
  std::string content(chunk.chunk_size, '\0');
  auto size = static_cast<unsigned int>(content.size());
  const int done = BZ2_bzBuffToBuffDecompress(content.data(), &size, stored.data(),
                                              static_cast<unsigned int>(stored.size()), 0, 0);
  if (done != BZ_OK || size != content.size()) return std::nullopt;
  return content;
}

/// Reads the records of a file.
class BagReader {
 public:
  BagReader(std::filesystem::path file, LittleEndianReader reader,
            const std::function<Result<void>(const Message&)>& use)
      : file_(std::move(file)), reader_(std::move(reader)), use_(use) {}

  Result<BagContent> read() {
    if (reader_.left() < kMagic.size() || reader_.bytes(kMagic.size(), "the version") != kMagic)
      return fail(ErrorCode::data_corrupt,
                  fmt::format("{}: does not begin with #ROSBAG V2.0", file_.string()),
                  "older bags are converted by `rosbag fix`; ROS 2's by `rosbags-convert`");
    while (reader_.left() > 0 && !content_.ends_early) {
      if (const auto read = record(); !read) return tl::unexpected(read.error());
    }
    return std::move(content_);
  }

 private:
  [[nodiscard]] tl::unexpected<Error> wrong(std::uint64_t position, std::string_view what) const {
    return fail(ErrorCode::data_corrupt, fmt::format("{}: byte {}: {}", file_.string(), position, what));
  }

  /// One record of the file itself.
  Result<void> record() {
    const std::uint64_t begin = reader_.position();
    const auto header = part("the header of a record");
    if (!header) return {};
    const auto fields = fields_of(*header);
    const auto operation = fields ? number(*fields, "op", 1) : std::nullopt;
    if (!operation) return wrong(begin, "no record of a bag");
    if (reader_.left() < 4) return end_early();
    const auto length = reader_.number<std::uint32_t>("the length of data");
    if (length > reader_.left()) return end_early();
    const std::uint64_t position = reader_.position();
    switch (static_cast<Operation>(*operation)) {
      case Operation::chunk:
        return chunk(*fields, {position, length, number(*fields, "size", 4).value_or(0),
                               text(*fields, "compression"), 0, 0});
      case Operation::connection:
        return connection(*fields, reader_.bytes(length, "a connection"), begin);
      case Operation::message: {
        const std::string data = reader_.bytes(length, "a message");
        return message(*fields, data, {0, 0, 0, {}, position, length}, begin);
      }
      case Operation::bag_header:
      case Operation::index:
      case Operation::chunk_info:
        reader_.skip(length, "data");
        return {};
    }
    return wrong(begin, fmt::format("a record of the unknown operation {}", *operation));
  }

  /// Bytes with their length before them; nothing where the file ends first.
  std::optional<std::string> part(std::string_view what) {
    const bool has_length = reader_.left() >= 4;
    const auto length = has_length ? reader_.number<std::uint32_t>(what) : 0;
    if (!has_length || length > reader_.left()) {
      static_cast<void>(end_early());
      return std::nullopt;
    }
    return reader_.bytes(length, what);
  }

  Result<void> end_early() {
    content_.ends_early = true;
    return {};
  }

  Result<void> chunk(const Fields& fields, MessagePlace place) {
    const std::uint64_t begin = place.chunk_position;
    if (!fields.contains("size") || place.chunk_size > kMostChunkBytes || place.chunk_bytes > kMostChunkBytes)
      return wrong(begin,
                   fmt::format("a chunk of {} bytes (allowed: up to {})", place.chunk_size, kMostChunkBytes));
    if (place.compression != "none" && place.compression != "bz2" && place.compression != "lz4")
      return wrong(begin, fmt::format("a chunk with the compression '{}' (none, bz2 and lz4 are read)",
                                      printable(place.compression)));
    const auto content = decompressed(reader_.bytes(place.chunk_bytes, "a chunk"), place);
    if (!content) return wrong(begin, fmt::format("a damaged chunk (compression {})", place.compression));
    std::string_view rest = *content;
    while (!rest.empty()) {
      const auto record = take_record(rest);
      if (!record) return wrong(begin, "a chunk with a damaged record");
      place.position = static_cast<std::uint64_t>(record->data.data() - content->data());
      place.bytes = record->data.size();
      Result<void> read;
      if (record->operation == Operation::connection) read = connection(record->fields, record->data, begin);
      if (record->operation == Operation::message) read = message(record->fields, record->data, place, begin);
      if (!read) return read;
    }
    return {};
  }

  Result<void> connection(const Fields& fields, std::string_view data, std::uint64_t position) {
    const auto id = number(fields, "conn", 4);
    const auto more = fields_of(data);
    if (!id || !more) return wrong(position, "a damaged record of a connection");
    content_.connections.try_emplace(static_cast<std::uint32_t>(*id),
                                     Connection{text(fields, "topic"), text(*more, "type")});
    return {};
  }

  Result<void> message(const Fields& fields, std::string_view data, const MessagePlace& place,
                       std::uint64_t position) {
    const auto id = number(fields, "conn", 4);
    const auto time = number(fields, "time", 8);
    if (!id || !time) return wrong(position, "a damaged record of a message");
    const auto found = content_.connections.find(static_cast<std::uint32_t>(*id));
    if (found == content_.connections.end())
      return wrong(position,
                   fmt::format("a message of connection {}, which no record before it describes", *id));
    const auto seconds = static_cast<std::int64_t>(*time & 0xFFFFFFFF);
    const auto nanoseconds = static_cast<std::int64_t>(*time >> 32);
    return use_({found->second, seconds * kNanosecondsPerSecond + nanoseconds, data, place});
  }

  std::filesystem::path file_;
  LittleEndianReader reader_;
  const std::function<Result<void>(const Message&)>& use_;
  BagContent content_;
};

}  // namespace

Result<BagContent> read_bag(const std::filesystem::path& file,
                            const std::function<Result<void>(const Message&)>& use) {
  auto reader = LittleEndianReader::open(file);
  if (!reader) return tl::unexpected(reader.error());
  return BagReader(file, std::move(*reader), use).read();
}

Result<std::string> message_data(const std::filesystem::path& file, const MessagePlace& place) {
  if (place.chunk_bytes == 0) return image_logs::bytes_of_file(file, place.position, place.bytes);
  auto stored = image_logs::bytes_of_file(file, place.chunk_position, place.chunk_bytes);
  if (!stored) return stored;
  const auto content = decompressed(std::move(*stored), place);
  if (!content || place.position > content->size() || place.bytes > content->size() - place.position)
    return fail(ErrorCode::data_corrupt,
                fmt::format("{}: byte {}: a damaged chunk, which was sound when the recording was opened",
                            file.string(), place.chunk_position));
  return content->substr(place.position, place.bytes);
}

}  // namespace fusebench::formats::rosbag
