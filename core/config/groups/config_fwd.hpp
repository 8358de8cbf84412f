// Forward declarations of the configuration and of its groups, for headers that only pass references on. With
// them, a change of an option compiles again only the sources that read it.
#pragma once

namespace fusebench::config {

struct Config;

struct AlignmentConfig;
struct BundlefusionConfig;
struct ColorDriftConfig;
struct CompensationConfig;
struct DepthConfig;
struct ElasticfusionConfig;
struct EvaluationConfig;
struct GeometricConfig;
struct HealthConfig;
struct IekfConfig;
struct InfinitamConfig;
struct InitialisationConfig;
struct LoopsConfig;
struct MotionConfig;
struct OpencvOdometryConfig;
struct PatchConfig;
struct PhotometricConfig;
struct PlaceFeaturesConfig;
struct RelocalisationConfig;
struct SegmentsConfig;
struct SelfCalibrationConfig;
struct SystemConfig;
struct TermsConfig;
struct TsdfConfig;

enum class Deformation;
enum class LoopMode;
enum class OdometryMethod;
enum class PeerDefects;
enum class Prior;
enum class Sampling;
enum class ShrinkTest;
enum class SystemMethod;

}  // namespace fusebench::config
