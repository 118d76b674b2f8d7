// SPDX-License-Identifier: Apache-2.0
#include "camera/lens/paraxial.h"

#include <cmath>
#include <stdexcept>

namespace petzval::camera {
namespace {

/// Paraxial ray: height, and index times angle, which refraction at a plane leaves alone. Welford
/// 1986, ch. 3.
struct ParaxialRay {
    double height, reduced_angle;
};

double curvature_at_vertex(const LensSurface& surface, Section section) {
    const auto without_power = section == Section::X ? Profile::CylinderX : Profile::CylinderY;
    if (surface.profile == without_power) return 0;
    double curvature = surface.curvature_1_mm;
    for (const auto& [power, coefficient] : surface.asphere)
        if (power == 2) curvature += 2 * coefficient;
    return curvature;
}

/// Paraxial lens in one section at one wavelength.
class ParaxialLens {
  public:
    ParaxialLens(const Lens& lens, double nm, Section section) : lens_(lens) {
        index_.push_back(1);
        for (const LensSurface& surface : lens.prescription().surfaces) {
            curvature_.push_back(curvature_at_vertex(surface, section));
            index_.push_back(surface.glass ? surface.glass->index(nm) : 1);
        }
    }

    [[nodiscard]] double curvature(int i) const { return curvature_[size_t(i)]; }
    [[nodiscard]] double before(int i) const { return index_[size_t(i)]; }
    [[nodiscard]] double after(int i) const { return index_[size_t(i) + 1]; }
    [[nodiscard]] double behind() const { return index_.back(); }

    void refract(ParaxialRay& ray, int i) const {
        ray.reduced_angle -= ray.height * (after(i) - before(i)) * curvature(i);
    }
    void go_to_next(ParaxialRay& ray, int i) const {
        ray.height +=
            ray.reduced_angle / after(i) * lens_.prescription().surfaces[size_t(i)].thickness_mm;
    }
    /// Ray followed from before surface `first` to behind surface `last`.
    [[nodiscard]] ParaxialRay follow(ParaxialRay ray, int first, int last) const {
        for (int i = first; i <= last; ++i) {
            if (i != first) go_to_next(ray, i - 1);
            refract(ray, i);
        }
        return ray;
    }

  private:
    const Lens& lens_;
    std::vector<double> curvature_, index_;
};

}  // namespace

FirstOrder first_order(const Lens& lens, double nm, Section section) {
    const ParaxialLens system(lens, nm, section);
    const int stop = lens.stop(), last = lens.last();
    // Columns of the matrices: where a unit of height and of angle end. Glass does not change at
    // the stop, so following a ray through it is following it to it.
    const auto height = system.follow({1, 0}, 0, last), angle = system.follow({0, 1}, 0, last);
    const auto height_to_stop = system.follow({1, 0}, 0, stop);
    const auto angle_to_stop = system.follow({0, 1}, 0, stop);
    const auto angle_from_stop = system.follow({0, 1}, stop, last);
    const double stop_diameter = 2 * lens.prescription().surfaces[size_t(stop)].semi_diameter_mm;

    FirstOrder out{};
    out.focal_length_mm = -1 / height.reduced_angle;
    out.back_focus_mm = -system.behind() * height.height / height.reduced_angle;
    out.front_focus_mm = angle.reduced_angle / height.reduced_angle;
    out.front_principal_mm = out.front_focus_mm + out.focal_length_mm;
    out.rear_principal_mm = out.back_focus_mm - system.behind() * out.focal_length_mm;
    out.entrance_pupil_mm = angle_to_stop.height / height_to_stop.height;
    out.exit_pupil_mm = -system.behind() * angle_from_stop.height / angle_from_stop.reduced_angle;
    out.entrance_pupil_diameter_mm = stop_diameter / std::fabs(height_to_stop.height);
    out.exit_pupil_diameter_mm = stop_diameter / std::fabs(angle_from_stop.reduced_angle);
    out.fnumber = std::fabs(out.focal_length_mm) / out.entrance_pupil_diameter_mm;
    return out;
}

std::vector<double> marginal_heights_mm(const std::vector<LensSurface>& surfaces, Section section) {
    std::vector<double> heights;
    ParaxialRay ray{1, 0};
    double before = 1;
    for (const LensSurface& surface : surfaces) {
        heights.push_back(ray.height);
        const double after = surface.glass ? surface.glass->index(kLineD_nm) : 1;
        ray.reduced_angle -= ray.height * (after - before) * curvature_at_vertex(surface, section);
        ray.height += ray.reduced_angle / after * surface.thickness_mm;
        before = after;
    }
    return heights;
}

ParaxialImage image_of(const Lens& lens, double object_mm, double nm, Section section) {
    const ParaxialLens system(lens, nm, section);
    // A ray from the foot of the object, at an angle of 1.
    const auto ray = system.follow({-object_mm, 1}, 0, lens.last());
    return {-system.behind() * ray.height / ray.reduced_angle, 1 / ray.reduced_angle};
}

Seidel seidel(const Lens& lens, double field_tan) {
    const auto& surfaces = lens.prescription().surfaces;
    for (const LensSurface& surface : surfaces)
        if (surface.profile != Profile::Rotational)
            throw std::invalid_argument("Seidel sums are for lenses without cylinders");
    const ParaxialLens system(lens, kLineD_nm, Section::Y), blue(lens, kLineF_nm, Section::Y),
        red(lens, kLineC_nm, Section::Y);
    const FirstOrder first = first_order(lens, kLineD_nm);
    ParaxialRay marginal{first.entrance_pupil_diameter_mm / 2, 0};
    ParaxialRay chief{-field_tan * first.entrance_pupil_mm, field_tan};
    const double invariant =
        chief.reduced_angle * marginal.height - marginal.reduced_angle * chief.height;

    Seidel out;
    for (int i = 0; i < lens.size(); ++i) {
        const double n = system.before(i), n_after = system.after(i), c = system.curvature(i);
        const double y = marginal.height, y_chief = chief.height;
        const double u = marginal.reduced_angle / n;
        // Refraction invariants n i of the two rays.
        const double a = marginal.reduced_angle + n * y * c;
        const double a_chief = chief.reduced_angle + n * y_chief * c;
        system.refract(marginal, i);
        system.refract(chief, i);
        const double change = marginal.reduced_angle / (n_after * n_after) - u / n;
        const double change_1_n = 1 / n_after - 1 / n;
        const double change_1_n2 = 1 / (n_after * n_after) - 1 / (n * n);
        const double dispersion =
            (blue.after(i) - red.after(i)) / n_after - (blue.before(i) - red.before(i)) / n;
        // Departure from the sphere of the same curvature at the vertex, in r^4 / 8.
        const LensSurface& surface = surfaces[size_t(i)];
        const double conic_c = surface.curvature_1_mm;
        double figure = (1 + surface.conic) * conic_c * conic_c * conic_c - c * c * c;
        for (const auto& [power, coefficient] : surface.asphere)
            if (power == 4) figure += 8 * coefficient;
        figure *= (n_after - n) * y;
        // The usual S5 = a_chief / a (S3 + S4) is 0 / 0 where the marginal ray meets the surface
        // squarely; this form of it is not.
        const double s5 = -a_chief * a_chief * a_chief * y * change_1_n2 +
                          (invariant + a_chief * y) * y_chief * a_chief * c * change_1_n;
        const SeidelSums sums{-a * a * y * change + figure * y * y * y,
                              -a * a_chief * y * change + figure * y * y * y_chief,
                              -a_chief * a_chief * y * change + figure * y * y_chief * y_chief,
                              -invariant * invariant * c * change_1_n,
                              s5 + figure * y_chief * y_chief * y_chief,
                              a * y * dispersion,
                              a_chief * y * dispersion};
        for (size_t k = 0; k < sums.size(); ++k) out.total[k] += sums[k];
        out.of_surface.push_back(sums);
        system.go_to_next(marginal, i);
        system.go_to_next(chief, i);
    }
    return out;
}

}  // namespace petzval::camera
