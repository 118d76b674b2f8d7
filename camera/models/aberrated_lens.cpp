// SPDX-License-Identifier: Apache-2.0
#include "camera/models/aberrated_lens.h"

#include <cmath>
#include <stdexcept>
#include <utility>

#include "camera/dispersion/strategies.h"
#include "core/spectrum/spectrum_table.h"

namespace petzval::camera {
namespace {

// Least f(h) in units of f: below it the ray is so far out that the closed form means nothing.
constexpr double kLeastZone = 0.5;

void require_stop(const Singlet& lens, double radius_mm, double focus_mm) {
    if (!(radius_mm >= 0)) throw std::invalid_argument("radius of the stop must not be negative");
    const double least_mm = std::fmin(std::fabs(lens.r1_mm), std::fabs(lens.r2_mm));
    bool narrow = radius_mm < least_mm;
    for (const double nm : {double(kFirst_nm), kLineD_nm, double(kLast_nm)}) {
        const SingletOptics at = lens.at(nm);
        const double rim_mm = zonal_focal_length_mm(at, focus_mm, radius_mm);
        narrow = narrow && rim_mm > kLeastZone * at.focal_mm;
    }
    if (!narrow)
        throw std::invalid_argument(
            "the stop is too wide for the curves of the lens: raise the f-number");
}

}  // namespace

AberratedLensCamera::AberratedLensCamera(AberratedLens lens)
    : in_(std::move(lens)),
      pose_(in_.to_world),
      at_d_(in_.singlet.at(kLineD_nm)),
      focus_mm_(in_.focus_m * 1e3),
      film_mm_(image_distance_mm(at_d_.focal_mm, focus_mm_)),
      tan_half_x_(std::tan(in_.yfov_rad / 2) * in_.aspect),
      tan_half_y_(std::tan(in_.yfov_rad / 2)) {
    require_stop(in_.singlet, in_.iris.bounding_radius_mm(), focus_mm_);
}

class AberratedLensCamera::Point {
  public:
    /// Rays through one point of the lens, which the wavelengths leave with vergences of their own.
    struct Rays {
        f4 weight{}, vergence_per_mm{};  ///< 1/S: finite even if the ray crosses no axis ahead
        V2f stop_mm;
        LensLosses<uint32_t> losses;
        [[nodiscard]] f4 weight_of_lanes() const { return weight; }
    };

    /// Camera, film point and bands must outlive it.
    Point(const AberratedLensCamera& camera, const FilmPoint& at, V2f stop_mm, const Bands& bands)
        : c_(camera), at_(at), bands_(bands), stop_mm_(stop_mm) {}

    [[nodiscard]] Rays rays(const LaneRequest& request) const {
        Rays out;
        out.stop_mm = stop_mm_;
        const float share = static_cast<float>(lane_count(bands_.on)) /
                            static_cast<float>(lane_count(request.lanes));
        float weight = c_.in_.exposure * share;
        if (c_.in_.vignetting) weight *= c_.in_.vignetting->factor(tangents(), out.stop_mm);
        find_vergences(request.lanes, splat(weight), out);
        return out;
    }
    [[nodiscard]] Ray ray(const Rays& rays, int lane) const {
        const V3f through_centre{tangents().x, tangents().y, -1.f};
        const V3f point_mm{rays.stop_mm.x, rays.stop_mm.y, 0.f};
        Ray out;
        out.origin = c_.pose_.origin + c_.pose_.to_world(point_mm * 1e-3f);
        out.direction =
            unit(c_.pose_.to_world(through_centre - point_mm * rays.vergence_per_mm[lane]));
        return out;
    }
    /// Landing by vergences: through a point of the lens, the same ray of the scene belongs to film
    /// points that differ by the vergences of the lanes.
    [[nodiscard]] FilmLanding landing(const Rays& rays, const LaneRequest& request) const {
        Rays all;
        all.stop_mm = rays.stop_mm;
        find_vergences(bands_.on, splat(1.f), all);
        const f4 off = all.vergence_per_mm - splat(all.vergence_per_mm[request.hero]);
        const V2f px = 0.5f * at_.pixel.frame_px / V2f(c_.tan_half_x_, c_.tan_half_y_);
        return {off * (rays.stop_mm.x * px.x), off * (-rays.stop_mm.y * px.y), all.weight,
                all.weight, vignetting_where(off, rays.stop_mm)};
    }
    [[nodiscard]] float exposure() const { return c_.in_.exposure; }

  private:
    /// Tangents of the angles at which the film point sees the lens's middle, right and up.
    [[nodiscard]] V2f tangents() const { return c_.tangents(at_.film); }
    /// Natural vignetting where each lane lands, over that of the film point.
    [[nodiscard]] f4 vignetting_where(f4 off, V2f stop_mm) const {
        f4 out = splat(1.f);
        if (!c_.in_.vignetting) return out;
        const float here = c_.in_.vignetting->factor(tangents(), stop_mm);
        for (int lane = 0; lane < 4; ++lane)
            out[lane] = c_.in_.vignetting->factor(tangents() + stop_mm * off[lane], stop_mm) / here;
        return out;
    }
    /// Vergences of the lanes whose closed form means something; the others get no weight. Only
    /// what holds between the wavelengths that the camera's constructor tried can fail here.
    void find_vergences(m4 lanes, f4 weight, Rays& out) const {
        const auto h_mm = double(out.stop_mm.length());
        for (int lane = 0; lane < 4; ++lane) {
            if (!lanes[lane]) continue;
            const double focal_mm = c_.zonal_mm(c_.index_of(bands_, lane), h_mm);
            if (!(focal_mm > kLeastZone / 2 * c_.at_d_.focal_mm)) continue;
            out.vergence_per_mm[lane] = static_cast<float>(1 / focal_mm - 1 / c_.film_mm_);
            out.weight[lane] = weight[lane];
        }
    }

    const AberratedLensCamera& c_;
    const FilmPoint& at_;
    const Bands& bands_;
    V2f stop_mm_;
};

CameraSample AberratedLensCamera::sample(const FilmPoint& at, const Bands& bands) const {
    return through(at, drawn_stop_mm(at), bands);
}

CameraSample AberratedLensCamera::through(const FilmPoint& at, V2f stop_mm,
                                          const Bands& bands) const {
    return sample_lens(Point(*this, at, stop_mm, bands), in_.dispersion, at.pixel, bands);
}

bool AberratedLensCamera::is_led(const FilmPoint& at, const Bands& bands) const {
    return one_ray(bands, in_.dispersion) ||
           (in_.dispersion == DispersionMode::Hero && at.pixel.filter);
}

StopPencil AberratedLensCamera::pencil(V2f film, double nm) const {
    const bool shared = in_.dispersion == DispersionMode::Shared;
    const SingletOptics optics = shared ? at_d_ : optics_at(in_.singlet.glass.index(nm));
    return {V2d(tangents(film)), 1e-3 * optics.focal_mm,
            1e3 * spherical_coefficient_per_mm(optics, focus_mm_) / 2, 1e3 / film_mm_};
}

V2f AberratedLensCamera::tangents(V2f film) const {
    return {(2.f * film.x - 1.f) * tan_half_x_, (1.f - 2.f * film.y) * tan_half_y_};
}

double AberratedLensCamera::index_of(const Bands& bands, int lane) const {
    return one_ray(bands, in_.dispersion) ? at_d_.n
                                          : in_.singlet.glass.index(double(bands.nm[lane]));
}

SingletOptics AberratedLensCamera::optics_at(double n) const {
    return {n, at_d_.focal_mm * (at_d_.n - 1) / (n - 1), at_d_.bending};
}

double AberratedLensCamera::zonal_mm(double n, double h_mm) const {
    if (!(n > 1)) return 0;
    return zonal_focal_length_mm(optics_at(n), focus_mm_, h_mm);
}

}  // namespace petzval::camera
