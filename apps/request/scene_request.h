// SPDX-License-Identifier: Apache-2.0
// Requests of a user: scene, camera, wavelengths. Numbers and names only; what becomes of them is
// decided by the other files of this room.
#pragma once

#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "camera/dispersion/dispersion_mode.h"
#include "camera/iris/iris_options.h"
#include "camera/lens/lens_options.h"
#include "camera/shutter.h"
#include "core/light/light_options.h"
#include "core/math/math.h"
#include "core/spectrum/bands.h"
#include "core/spectrum/bins.h"
#include "core/traversal/traversal_options.h"
#include "io/file/overwrite.h"
#include "io/gltf/choices.h"
#include "io/gltf/validate/source.h"
#include "io/picture/picture_budget.h"

namespace petzval::apps {

/// Greatest distance that is not called infinity.
inline constexpr float kFarthestFocus_m = 1e9f;

struct FocusAuto {};
struct FocusDistance {
    float m;  ///< from the entrance pupil of the lens in focus; may be infinite
};
struct FocusPixel {
    int x, y;  ///< of the full frame; its centre is meant
};
using Focus = std::variant<FocusAuto, FocusDistance, FocusPixel>;

/// Exposure of the picture. Normalised: an even scene is as bright as it is through a pinhole,
/// whatever the iris. Photographic: 78 / ISO lx s on the film become 1 (saturation: ISO 12232:2019,
/// 6.2).
enum class ExposureMode : uint8_t { Normalised, Photographic };

/// Source of the angle of view: a lens's own focal length, or the camera's, to which the lens is
/// scaled.
enum class Fit : uint8_t { Lens, Fov };

/// Ghosts of a traced lens: light that two of its surfaces reflect. Auto: wherever its coating
/// reflects any; Only: they alone make the picture.
enum class GhostUse : uint8_t { Auto, Off, Only };
enum class DiffractionUse : uint8_t { Off, Auto };

/// Vertical angles of view that a perspective camera may be asked for.
inline constexpr float kSmallestFov_deg = 0.001f, kLargestFov_deg = 179.f;

/// Request for a camera. Everything absent means: as the file has it, else a sensible choice that
/// is reported.
struct CameraRequest {
    std::optional<std::string> name;            ///< of the file's cameras, or its index
    std::optional<std::array<V3f, 2>> look_at;  ///< eye and target
    std::optional<M44f> pose;  ///< to the world, of a camera that looks along -z: that of the name
    /// Turn of the camera about a vertical axis, counter-clockwise from above. Given, a camera that
    /// frames the scene stands where it sees all of it from all around.
    std::optional<float> orbit_deg;
    /// Point of that axis; absent: the target, or the middle of the scene.
    std::optional<V3f> orbit_about;
    std::optional<float> fov_deg;  ///< vertical
    /// "pinhole", "thin", "singlet:GLASS[,BENDING]", "singlet:GLASS,R1_MM,R2_MM", the name of a
    /// lens in assets/lenses, or a file.
    std::optional<std::string> lens;
    std::optional<float> fstop, focal_length_mm, lens_radius_m;
    std::optional<float> film_distance_mm;  ///< from a thin lens
    std::optional<V2f> sensor_mm;
    std::optional<Focus> focus;
    camera::FocusBy focus_by = camera::FocusBy::Paraxial;
    Fit fit = Fit::Lens;
    std::optional<std::string> aperture;  ///< as parse_aperture reads it
    camera::ApertureScale aperture_scale = camera::ApertureScale::EqualArea;
    std::optional<camera::IrisSampling> iris_sampling;
    std::optional<camera::DispersionMode>
        dispersion;  ///< absent: as a plan finds, or dispersion_by()
    camera::Coating coating = camera::Coating::Ideal;
    GhostUse ghosts = GhostUse::Auto;
    DiffractionUse diffraction = DiffractionUse::Off;
    camera::Precision precision = camera::Precision::Float;
    ExposureMode exposure = ExposureMode::Normalised;
    float iso = 100, shutter_s = 0.01f;
    /// Given: what moves is blurred. The shutter's time is that of one which opens and closes at
    /// once and lets as much light in.
    std::optional<camera::ShutterCurve> shutter_curve;
    std::optional<io::PictureBudget>
        iris_pictures;  ///< what those of the scene leave; absent: usual
    /// Fall-off to the corners of lenses that are not traced; absent: with photographic exposure.
    std::optional<bool> natural_vignetting;
    std::vector<std::filesystem::path> glasses;  ///< catalogues that go before those that ship

    /// How long the shutter is not closed, in seconds; 0: nothing is blurred.
    [[nodiscard]] double open_s() const {
        return shutter_curve ? double(shutter_s) / double(shutter_curve->efficiency()) : 0;
    }
    /// How wavelengths pass through the lens where no plan chooses: along one ray if its glass does
    /// not disperse.
    [[nodiscard]] camera::DispersionMode dispersion_by(bool glass_disperses) const {
        return dispersion.value_or(glass_disperses ? camera::DispersionMode::Hero
                                                   : camera::DispersionMode::Shared);
    }
};

enum class SpectralMode : uint8_t { Auto, Rgb, Wavelengths };
enum class WhiteBalance : uint8_t { None, Illuminant };

/// The illuminant and the response of a picture that needs no wavelengths.
inline constexpr std::string_view kUsualIlluminant = "d65", kUsualResponse = "cie1931";

struct SpectralRequest {
    SpectralMode mode = SpectralMode::Auto;
    std::optional<Bins> bins;
    /// Names, or CSV files.
    std::string illuminant{kUsualIlluminant}, response{kUsualResponse};
    WhiteBalance white_balance = WhiteBalance::None;
};

/// Name of the built-in environment: what a scene gets that nothing lights.
inline constexpr const char* kStudioLight = "studio";

/// Whether camera rays are sent to targets. Auto: where they pay.
enum class TargetUse : uint8_t { Auto, Off };

/// Request for a scene. Everything absent means: as the file has it, else a sensible choice that is
/// reported.
struct SceneRequest {
    std::filesystem::path scene;
    V2i size{1280, 720};
    CameraRequest camera;
    std::optional<std::filesystem::path> environment;  ///< a picture, or kStudioLight
    float environment_rotate_deg = 0, environment_strength = 1;
    std::optional<Rgb> background;
    std::optional<LightChoiceKind> light_choice;  ///< absent: as a plan finds, or the tree
    Traversal traversal = Traversal::Robust;
    TargetUse targets = TargetUse::Auto;  ///< whether camera rays are sent to small lamps
    SpectralRequest spectral;
    std::vector<io::NamedFile> outputs;  ///< files to be written: a scene that reads one is refused
    /// Memory for decoded pictures; absent: half of what can be had.
    std::optional<uint64_t> picture_memory_bytes;
    io::FileScope scope = io::FileScope::Anywhere;  ///< of files that the scene names
    io::GltfChoices choices;                        ///< what is taken of the scene's file

    /// Budget of decoded pictures.
    [[nodiscard]] io::PictureBudget pictures() const {
        return picture_memory_bytes ? io::PictureBudget(*picture_memory_bytes)
                                    : io::PictureBudget();
    }
    /// How one of many lights is chosen where no plan chooses.
    [[nodiscard]] LightChoiceKind lights() const {
        return light_choice.value_or(LightChoiceKind::Tree);
    }
};

}  // namespace petzval::apps
