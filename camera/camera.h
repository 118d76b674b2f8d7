// SPDX-License-Identifier: Apache-2.0
// Camera interface: a point on the film in, weighted rays out.
#pragma once

#include <array>
#include <memory>
#include <span>

#include "core/math/ray.h"
#include "core/math/steps.h"
#include "core/sampling/filter.h"
#include "core/sampling/sampler.h"
#include "core/spectrum/bands.h"

namespace petzval::camera {

/// Pixel filter that drew a film point; nullptr: unknown, and lanes are split where it is asked
/// for.
struct PixelFilter {
    const Filter* filter = nullptr;
    V2f offset_px{0.f};  ///< of the film point from the pixel's centre, y down
    V2f frame_px{1.f};   ///< width and height of the full frame
};

/// Point on the film, and the random numbers from which a camera draws the rest (Dim::Lens).
struct FilmPoint {
    /// Position in [0, 1)^2 over the full frame, (0, 0) at the top left as the picture is seen; a
    /// pixel filter reaches a little beyond.
    V2f film{0.f};
    Sampler sampler{};
    PixelFilter pixel{};
    float time = kMiddleOfShutter;  ///< share of the exposure that has passed
};

/// A world-space ray; direction has unit length.
struct CameraPath {
    Ray ray;
    f4 weight;  ///< radiance along the ray times this is the film's estimate
    /// Weight of multiple importance sampling, on the light: rays to targets bring the rest.
    /// Coverage and layers do without.
    float mis_weight = 1;
    m4 lanes;  ///< bands that share this ray
    /// The hero lane (Bands::hero) decides the ray, and must then decide nothing else.
    bool hero_decided = false;
    /// Aimed at a small lamp: alpha and layers do without.
    bool to_target = false;
    bool of_ghost = false;  ///< brings light that the lens reflects; to_target as well
    /// Number of the ray to a target among so many of the sample: each has random numbers of its
    /// own.
    uint8_t target_ray = 0, target_rays = 1;
};

/// Counts of the wavelength lanes that a lens was asked for, by why it lost them; drawn - lost()
/// passed. All 0: a camera that has nothing to lose light at.
template <class Count>
struct LensLosses {
    Count drawn{};
    Count vignetted{};  ///< by a rim, or outside the iris
    Count totally_reflected{};
    Count missed{};     ///< no meeting with a surface
    Count unreached{};  ///< no ray leads from the film point to the iris point

    [[nodiscard]] Count lost() const {
        return static_cast<Count>(vignetted + totally_reflected + missed + unreached);
    }
    template <class Other>
    LensLosses& operator+=(const LensLosses<Other>& o) {
        drawn += o.drawn;
        vignetted += o.vignetted;
        totally_reflected += o.totally_reflected;
        missed += o.missed;
        unreached += o.unreached;
        return *this;
    }
};

/// Camera paths of one film point. None: vignetted. 1: shared by all lanes. 2 to 4: split by
/// dispersion. Rays to targets come with them: as many again, or those of a shared ray. All these
/// may come again of a lamp's star, and 5 of ghosts.
class CameraSample {
  public:
    static constexpr size_t kMostTargetRays = 8;  ///< of a ray that all lanes share
    static constexpr size_t kMostPaths = 2 * (1 + kMostTargetRays) + 5;

    LensLosses<uint32_t> lanes;
    float exposure = 1;  ///< mean weight of a lane where nothing is lost
    /// Density with which a traced lens draws the ray, 1/sr of projected solid angle at the film.
    float density = 0;

    CameraSample() {}  // NOLINT: paths are not made before they are there
    CameraSample(const CameraSample& o) { *this = o; }
    CameraSample& operator=(const CameraSample& o) {
        lanes = o.lanes, exposure = o.exposure, density = o.density, size_ = o.size_;
        std::uninitialized_copy(o.begin(), o.end(), begin());
        return *this;
    }

    [[nodiscard]] bool empty() const { return size_ == 0; }
    [[nodiscard]] size_t size() const { return size_; }
    [[nodiscard]] CameraPath& operator[](size_t i) { return paths_[i]; }
    [[nodiscard]] const CameraPath& operator[](size_t i) const { return paths_[i]; }
    [[nodiscard]] CameraPath* begin() { return paths_.data(); }
    [[nodiscard]] CameraPath* end() { return paths_.data() + size_; }
    [[nodiscard]] const CameraPath* begin() const { return paths_.data(); }
    [[nodiscard]] const CameraPath* end() const { return paths_.data() + size_; }
    /// Appends a path, to be filled in; at most kMostPaths may be added.
    CameraPath& add() { return *std::construct_at(&paths_[size_++]); }

  private:
    size_t size_ = 0;
    union {
        std::array<CameraPath, kMostPaths> paths_;  ///< made by add()
    };
};

/// Most film points that a camera takes at once.
inline constexpr size_t kMostFilmPoints = 8;

/// A camera answers one question: which rays bring the light that lands at a point of the film.
class Camera {
  public:
    virtual ~Camera() = default;
    /// Weighted rays of one point of the film, drawn by its sampler: none where the lens lets
    /// nothing through, one that all bands share, or up to four. Thread-safe.
    [[nodiscard]] virtual CameraSample sample(const FilmPoint&, const Bands&) const = 0;
    /// Samples of up to kMostFilmPoints film points, the same to the bit as sample() gives: a
    /// camera may find them faster all at once. All or none of the bands are spectral, and of the
    /// points have a pixel filter.
    virtual void sample_all(std::span<const FilmPoint> points, std::span<const Bands> bands,
                            std::span<CameraSample> out) const {
        for (size_t i = 0; i < points.size(); ++i) out[i] = sample(points[i], bands[i]);
    }

  protected:
    /// sample() of a camera that has sample_all().
    [[nodiscard]] CameraSample one_of_all(const FilmPoint& point, const Bands& bands) const {
        CameraSample out;
        sample_all({&point, 1}, {&bands, 1}, {&out, 1});
        return out;
    }
};

}  // namespace petzval::camera
