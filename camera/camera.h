// SPDX-License-Identifier: Apache-2.0
// Camera interface: a point on the film in, weighted rays out.
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <span>
#include <utility>

#include "camera/shutter.h"
#include "camera/target.h"
#include "core/math/ray.h"
#include "core/sampling/filter.h"
#include "core/sampling/sampler.h"
#include "core/spectrum/bands.h"

namespace petzval {

/// The pixel filter that drew a film point; nullptr: none is known, and a camera that asks for it
/// splits its lanes instead.
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
};

/// A world-space ray; direction has unit length.
struct CameraPath {
    Ray ray;
    f4 weight;  ///< radiance along the ray times this is the film's estimate
    /// Weight of multiple importance sampling, on the light: rays to targets bring the rest.
    /// Coverage and layers do without.
    float mis_weight = 1;
    m4 lanes;  ///< bands that share this ray
    /// The ray depends on which lane is the hero (Bands::hero), which must then decide nothing
    /// else.
    bool hero_decided = false;
    /// Fills the sample's alpha; the first path that does fills its layers too.
    bool fills_layers = true;
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
/// dispersion.
class CameraSample {
  public:
    static constexpr size_t kMostPaths = 4;

    LensLosses<uint32_t> lanes;
    float exposure = 1;  ///< mean weight of a lane where nothing is lost

    [[nodiscard]] bool empty() const { return size_ == 0; }
    [[nodiscard]] size_t size() const { return size_; }
    [[nodiscard]] CameraPath& operator[](size_t i) { return paths_[i]; }
    [[nodiscard]] const CameraPath& operator[](size_t i) const { return paths_[i]; }
    [[nodiscard]] CameraPath* begin() { return paths_.data(); }
    [[nodiscard]] CameraPath* end() { return paths_.data() + size_; }
    [[nodiscard]] const CameraPath* begin() const { return paths_.data(); }
    [[nodiscard]] const CameraPath* end() const { return paths_.data() + size_; }
    /// Appends a path, to be filled in; at most kMostPaths may be added.
    CameraPath& add() { return paths_[size_++]; }
    /// Makes this a sample of rays to targets: they fill no layers, and no losses are counted.
    void leave_layers() {
        lanes = {};
        for (CameraPath& path : *this) path.fills_layers = false;
    }

  private:
    size_t size_ = 0;
    std::array<CameraPath, kMostPaths> paths_;
};

/// Most film points that a camera takes at once.
inline constexpr size_t kMostFilmPoints = 8;

/// A camera: pinhole, thin lens, singlet or real lens.
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

    /// Whether the camera can send rays to targets.
    [[nodiscard]] virtual bool takes_targets() const { return false; }
    /// A target made ready for the film; nothing where no ray seems to meet its middle, or the
    /// camera takes no targets.
    [[nodiscard]] virtual std::optional<PreparedTarget> prepared(const Target&) const {
        return std::nullopt;
    }
    /// A target made ready for the film points of a cell, with a chance of 1; nothing where no ray
    /// from there seems to meet its middle.
    [[nodiscard]] virtual std::optional<ListedTarget> listed(const PreparedTarget&,
                                                             const FilmCell&) const {
        return std::nullopt;
    }
    /// Paths of the same film points to one of the targets of each: together with those of
    /// sample(), by their shares, an estimate without a bias (balance heuristic, Veach and Guibas
    /// 1995). None for a film point that has no targets, or where the ray is blocked. As
    /// sample_all().
    virtual void sample_targets(std::span<const FilmPoint> points, std::span<const Bands>,
                                std::span<const TargetList>, std::span<CameraSample> out) const {
        for (size_t i = 0; i < points.size(); ++i) out[i] = {};
    }
    /// Targets from here on, made ready by this camera; nullptr: none.
    void set_targets(std::shared_ptr<const TargetGrid> targets) { targets_ = std::move(targets); }
    [[nodiscard]] const TargetGrid* targets() const { return targets_.get(); }
    /// The same, for another camera that has the same rays.
    [[nodiscard]] const std::shared_ptr<const TargetGrid>& shared_targets() const {
        return targets_;
    }

    /// The shutter, for whoever asks for rays: those of the functions above are of its middle.
    void set_shutter(std::shared_ptr<const Shutter> shutter) { shutter_ = std::move(shutter); }
    /// nullptr: nothing moves.
    [[nodiscard]] const Shutter* shutter() const { return shutter_.get(); }

  protected:
    [[nodiscard]] TargetList targets_at(const FilmPoint& at) const {
        return targets_ ? targets_->at(at.film) : TargetList();
    }

  private:
    std::shared_ptr<const TargetGrid> targets_;
    std::shared_ptr<const Shutter> shutter_;
};

}  // namespace petzval
