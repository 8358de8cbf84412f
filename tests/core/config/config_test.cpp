#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>

#include "core/base/io/fingerprint.hpp"
#include "core/config/config.hpp"
#include "core/config/config_access.hpp"
#include "core/config/toml_document.hpp"
#include "core/config/variants.hpp"

namespace fusebench {

using namespace config;

namespace {

class ConfigFile : public ::testing::Test {
 protected:
  void SetUp() override {
    const auto* test = ::testing::UnitTest::GetInstance()->current_test_info();
    file_ =
        std::filesystem::temp_directory_path() / (std::string("fusebench_config_") + test->name() + ".toml");
  }
  void TearDown() override { std::filesystem::remove(file_); }
  void write(const std::string& text) const { std::ofstream(file_) << text; }
  [[nodiscard]] Result<void> apply(const std::string& text) {
    write(text);
    return apply_config_file(config_, file_);
  }
  [[nodiscard]] std::string place(int line) const { return file_.string() + ":" + std::to_string(line); }

  std::filesystem::path file_;
  EffectiveConfig config_;
};

TEST(Options, EveryOptionTakesItsOwnValueBack) {
  const Config defaults;
  const auto rows = describe_options(defaults);
  ASSERT_GT(rows.size(), 40U);
  for (const OptionRow& row : rows) {
    Config copy;
    EXPECT_TRUE(set_option(copy, row.key, parse_option_value(row.value)).has_value())
        << row.key << " = " << row.value;
    EXPECT_EQ(config_hash(copy), config_hash(defaults)) << row.key;
    EXPECT_FALSE(row.sentence.empty()) << row.key;
  }
}

TEST(Options, EveryOptionCanBeChangedAndReadBackAlone) {
  const Config defaults;
  const auto before = describe_options(defaults);
  for (std::size_t i = 0; i < before.size(); ++i) {
    const OptionRow& row = before[i];
    OptionValue changed;
    if (row.type == "flag") {
      changed = row.value != "true";
    } else if (row.type == "choice") {
      const std::string first = row.range.substr(0, row.range.find(' '));
      const std::string last = row.range.substr(row.range.rfind(' ') + 1);
      changed = row.value == "\"" + first + "\"" ? last : first;
    } else {
      const std::string low = row.range.substr(0, row.range.find(' '));
      const std::string high = row.range.substr(row.range.rfind(' ') + 1);
      changed = parse_option_value(std::stod(low) == std::stod(row.value) ? high : low);
    }
    Config config;
    ASSERT_TRUE(set_option(config, row.key, changed).has_value()) << row.key << " = " << to_toml(changed);
    const auto after = describe_options(config);
    for (std::size_t k = 0; k < after.size(); ++k) {
      if (k == i) {
        EXPECT_NE(after[k].value, before[k].value) << row.key;
      } else {
        EXPECT_EQ(after[k].value, before[k].value) << row.key << " also changed " << after[k].key;
      }
    }
    EXPECT_NE(config_hash(config), config_hash(defaults)) << row.key;
  }
}

TEST(Options, EveryNumberIsReadAtTheEndsOfItsRangeAndRefusedBeyond) {
  for (const OptionRow& row : describe_options(Config{})) {
    if (row.type != "number" && row.type != "integer") continue;
    const std::string low = row.range.substr(0, row.range.find(' '));
    const std::string high = row.range.substr(row.range.rfind(' ') + 1);
    Config config;
    for (const std::string& end : {low, high})
      EXPECT_TRUE(set_option(config, row.key, parse_option_value(end)).has_value())
          << row.key << " = " << end;
    const std::string before = config_hash(config);
    const auto beyond = [&](const std::string& end, int step) -> OptionValue {
      if (row.type == "integer") return static_cast<std::int64_t>(std::stoll(end) + step);
      return std::nextafter(std::stod(end), step * std::numeric_limits<double>::infinity());
    };
    for (const OptionValue& value : {beyond(low, -1), beyond(high, 1)}) {
      const auto refused = set_option(config, row.key, value);
      ASSERT_FALSE(refused.has_value()) << row.key << " = " << to_toml(value);
      EXPECT_NE(refused.error().message.find(row.range), std::string::npos) << refused.error().message;
    }
    EXPECT_EQ(config_hash(config), before) << row.key << " changed though it was refused";
  }
}

TEST(Options, UnknownKeyNamesTheNearest) {
  Config config;
  const auto result = set_option(config, "iekf.max_iteration", std::int64_t{3});
  ASSERT_FALSE(result.has_value());
  EXPECT_EQ(result.error().code, ErrorCode::configuration);
  EXPECT_NE(result.error().message.find("iekf.max_iterations"), std::string::npos) << result.error().message;
}

TEST(Options, OutOfRangeNamesKeyValueAndRange) {
  Config config;
  const auto result = set_option(config, "iekf.max_iterations", std::int64_t{900});
  ASSERT_FALSE(result.has_value());
  EXPECT_EQ(result.error().message, "iekf.max_iterations = 900 (allowed: 1 .. 200)");
  EXPECT_EQ(config.iekf.max_iterations, Config{}.iekf.max_iterations);
}

TEST(Options, NotANumberAndInfinityAreOutOfRange) {
  Config config;
  EXPECT_FALSE(set_option(config, "depth.max_m", std::nan("")).has_value());
  EXPECT_FALSE(set_option(config, "depth.max_m", std::numeric_limits<double>::infinity()).has_value());
  EXPECT_FALSE(
      set_option(config, "iekf.max_iterations", std::numeric_limits<std::int64_t>::max()).has_value());
}

TEST(Options, WrongTypesAreRefused) {
  Config config;
  EXPECT_FALSE(set_option(config, "iekf.max_iterations", 8.0).has_value());
  EXPECT_FALSE(set_option(config, "iekf.max_iterations", true).has_value());
  EXPECT_FALSE(set_option(config, "depth.max_m", std::string("far")).has_value());
  EXPECT_FALSE(set_option(config, "terms.visibility_test", std::int64_t{1}).has_value());
  EXPECT_FALSE(set_option(config, "terms.prior", true).has_value());
  const auto choice = set_option(config, "terms.prior", std::string("gps"));
  ASSERT_FALSE(choice.has_value());
  EXPECT_NE(choice.error().message.find("imu | constant_velocity"), std::string::npos);
}

TEST(Options, IntegersAreNumbers) {
  Config config;
  ASSERT_TRUE(set_option(config, "depth.max_m", std::int64_t{4}).has_value());
  EXPECT_EQ(config.depth.max_m, 4.0);
}

TEST(Options, AssignmentsParseAndKeepTheirOrigin) {
  EffectiveConfig config;
  ASSERT_TRUE(config.set_assignment("terms.prior=constant_velocity").has_value());
  ASSERT_TRUE(config.set_assignment("depth.max_m=3.5").has_value());
  EXPECT_EQ(config.values().terms.prior, Prior::constant_velocity);
  EXPECT_EQ(config.values().depth.max_m, 3.5);
  EXPECT_EQ(config.origin("depth.max_m"), "--set");
  EXPECT_EQ(config.origin("depth.min_m"), "default");
  EXPECT_FALSE(config.set_assignment("depth.max_m").has_value());
  EXPECT_FALSE(config.set_assignment("=3").has_value());
}

TEST(Options, HashIdentifiesValuesNotOrigins) {
  EffectiveConfig a;
  EffectiveConfig b;
  ASSERT_TRUE(a.set("depth.max_m", 5.0, "--set").has_value());
  EXPECT_EQ(config_hash(a.values()), config_hash(b.values()));
  EXPECT_EQ(config_hash(a.values()).size(), 16U);
  ASSERT_TRUE(b.set("depth.max_m", 5.000000001, "--set").has_value());
  EXPECT_NE(config_hash(a.values()), config_hash(b.values()));
}

TEST(Options, VariantsDifferInTheirHashes) {
  std::vector<std::string> hashes;
  for (const Variant& variant : all_variants())
    hashes.push_back(config_hash(variant_config(variant).values()));
  std::sort(hashes.begin(), hashes.end());
  EXPECT_EQ(std::unique(hashes.begin(), hashes.end()), hashes.end());
}

TEST(Options, RelationsAreChecked) {
  Config config;
  EXPECT_TRUE(check_relations(config).has_value());
  config.depth.min_m = config.depth.max_m;
  EXPECT_FALSE(check_relations(config).has_value());
  config = Config{};
  config.tsdf.truncation_m = 1.5 * config.tsdf.voxel_m;
  EXPECT_FALSE(check_relations(config).has_value());
}

TEST(Options, AKeyframeHasEnoughFeaturesToBeFound) {
  Config config;
  EXPECT_FALSE(set_option(config, "relocalisation.min_inliers", std::int64_t{61}).has_value());
  EXPECT_FALSE(set_option(config, "place_features.max_count", std::int64_t{59}).has_value());
  EXPECT_TRUE(set_option(config, "relocalisation.min_inliers", std::int64_t{60}).has_value());
}

TEST_F(ConfigFile, SetsValuesWithTheirLines) {
  ASSERT_TRUE(apply("[iekf]\nmax_iterations = 8\n\n[terms]\nprior = \"constant_velocity\"\n").has_value());
  EXPECT_EQ(config_.values().iekf.max_iterations, 8);
  EXPECT_EQ(config_.values().terms.prior, Prior::constant_velocity);
  EXPECT_EQ(config_.origin("iekf.max_iterations"), place(2));
  EXPECT_EQ(config_.origin("terms.prior"), place(5));
}

TEST_F(ConfigFile, ErrorsNameFileAndLine) {
  const auto expect_at = [&](const std::string& text, int line, const std::string& part) {
    const auto result = apply(text);
    ASSERT_FALSE(result.has_value()) << text;
    EXPECT_EQ(result.error().code, ErrorCode::configuration);
    EXPECT_TRUE(result.error().message.starts_with(place(line) + ":")) << result.error().message;
    EXPECT_NE(result.error().message.find(part), std::string::npos) << result.error().message;
  };
  expect_at("[iekf]\n\nmax_iteration = 8\n", 3, "iekf.max_iterations");
  expect_at("[iekf]\nmax_iterations = \"many\"\n", 2, "1 .. 200");
  expect_at("[iekf]\nmax_iterations = [8]\n", 2, "one value");
  expect_at("[iekf]\nmax_iterations = 1979-05-27\n", 2, "max_iterations");
  expect_at("[iekf]\nmax_iterations = = 8\n", 2, "TOML");
  expect_at("\n[iefk]\n", 2, "nearest: iekf");
}

TEST_F(ConfigFile, MissingFileIsMissingData) {
  const auto result = apply_config_file(config_, file_.string() + ".absent");
  ASSERT_FALSE(result.has_value());
  EXPECT_EQ(result.error().code, ErrorCode::data_missing);
}

TEST(Toml, ValuesReadBackTheSame) {
  for (const double value : {0.1, 1.0, 1e-5, 1e300, -0.0, 1.0 / 3.0}) {
    const auto back = parse_option_value(to_toml(value));
    ASSERT_TRUE(std::holds_alternative<double>(back)) << to_toml(value);
    EXPECT_EQ(std::get<double>(back), value);
  }
}

TEST(Options, TheHashIsOfAllKeysAndValues) {
  for (const Variant& variant : all_variants()) {
    const Config config = variant_config(variant).values();
    io::Fingerprint text;
    for (const OptionRow& row : describe_options(config)) text.add(row.key + "=" + row.value + "\n");
    EXPECT_EQ(config_hash(config), text.hex().substr(0, 16)) << variant.name;
  }
}

TEST_F(ConfigFile, EditsOnlyWhatItChanges) {
  ASSERT_TRUE(config_.set("tsdf.voxel_m", 0.02, "variant x"));
  const std::string hash = config_hash(config_.values());
  ASSERT_TRUE(apply("[tsdf]\nvoxel_m = 0.02\nmax_weight = 64\ntruncation_m = 0.04\n"));
  EXPECT_EQ(config_hash(config_.values()), hash);
  EXPECT_EQ(config_.origin("tsdf.voxel_m"), "variant x");
  EXPECT_EQ(config_.origin("tsdf.max_weight"), "default");
  ASSERT_TRUE(apply("[tsdf]\nvoxel_m = 0.01\nmax_weight = 64\n"));
  EXPECT_EQ(config_.origin("tsdf.voxel_m"), place(2)) << "back to the default is an edit of the variant";
  EXPECT_EQ(config_.origin("tsdf.max_weight"), "default");
}

}  // namespace
}  // namespace fusebench
