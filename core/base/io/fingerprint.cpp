#include "core/base/io/fingerprint.hpp"

#include <fmt/format.h>
#include <xxhash.h>

#include <array>
#include <fstream>

#include "core/base/io/input_file.hpp"

namespace fusebench::io {

struct Fingerprint::State {
  State() : xxh(XXH3_createState()), file(XXH3_createState()) { XXH3_128bits_reset(xxh); }
  ~State() {
    XXH3_freeState(file);
    XXH3_freeState(xxh);
  }
  State(const State&) = delete;
  State& operator=(const State&) = delete;
  XXH3_state_t* xxh;
  XXH3_state_t* file;  ///< of the file that is being added, 64 bits
};

ContentHash content_hash(std::string_view bytes) {
  return {bytes.size(), XXH3_64bits(bytes.data(), bytes.size())};
}

Fingerprint::Fingerprint() : state_(std::make_unique<State>()) {}
Fingerprint::~Fingerprint() = default;
Fingerprint::Fingerprint(Fingerprint&&) noexcept = default;
Fingerprint& Fingerprint::operator=(Fingerprint&&) noexcept = default;

void Fingerprint::add(std::string_view bytes) {
  // The length goes first, so that ("ab", "c") and ("a", "bc") differ.
  const std::uint64_t size = bytes.size();
  XXH3_128bits_update(state_->xxh, &size, sizeof size);
  XXH3_128bits_update(state_->xxh, bytes.data(), bytes.size());
}

Result<ContentHash> Fingerprint::add_file(const std::filesystem::path& file) {
  std::ifstream stream = input_file(file);
  if (!stream) {
    return fail(ErrorCode::data_missing, fmt::format("{}: cannot be opened", file.string()));
  }
  std::array<char, 1 << 16> buffer{};
  std::uint64_t total = 0;
  XXH3_64bits_reset(state_->file);
  while (stream.read(buffer.data(), buffer.size()) || stream.gcount() > 0) {
    const auto count = static_cast<std::size_t>(stream.gcount());
    XXH3_128bits_update(state_->xxh, buffer.data(), count);
    XXH3_64bits_update(state_->file, buffer.data(), count);
    total += count;
  }
  if (stream.bad()) return fail(ErrorCode::data_corrupt, fmt::format("{}: read error", file.string()));
  XXH3_128bits_update(state_->xxh, &total, sizeof total);
  return ContentHash{total, XXH3_64bits_digest(state_->file)};
}

std::string Fingerprint::hex() const {
  const XXH128_hash_t hash = XXH3_128bits_digest(state_->xxh);
  return fmt::format("{:016x}{:016x}", hash.high64, hash.low64);
}

}  // namespace fusebench::io
