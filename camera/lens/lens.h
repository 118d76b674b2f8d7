// SPDX-License-Identifier: Apache-2.0
// Lens: a prescription made ready for rays.
#pragma once

#include <vector>

#include "camera/lens/number.h"
#include "camera/lens/prescription.h"
#include "core/spectrum/spectrum_table.h"

namespace petzval::camera {

/// Shapes of surfaces that cost differently.
enum class Shape : uint8_t {
    Sphere,   ///< planes as well
    Quadric,  ///< conics and cylinders
    Asphere
};

/// Surface data for the trace, in half a cache line of floats: the quadric curvature_x x^2 +
/// curvature_y y^2 + curvature_z z^2 = 2 z and what is behind it. An asphere deviates from it.
template <class S>
struct SurfaceFacts {
    S curvature_x = 0, curvature_y = 0;  ///< 1/mm; 0 along the axis of a cylinder
    S curvature_z = 0;                   ///< (1 + k) c
    S gap_mm = 0;                        ///< to the next vertex; of the last surface: to the film
    S semi_diameter2_mm2 = 0;
    Shape shape = Shape::Sphere;
    uint8_t medium_before = 0, medium_after = 0;  ///< in Lens::media
    uint16_t asphere = 0;                         ///< in Lens::aspheres
};

/// Asphere, r^2 = across_x x^2 + across_y y^2: sag = c r^2 / (1 + sqrt(1 - (1 + k) c^2 r^2)) + sum
/// of even[i] r^(2 + 2 i) + sum of odd[i] r^(3 + 2 i).
template <class S>
struct Asphere {
    S curvature = 0, one_plus_k = 1;
    S across_x = 1, across_y = 1;
    std::vector<S> even, odd;
};

/// Most different media of a lens, air among them, so that an index table is a plain array. No lens
/// has so many.
inline constexpr int kMaxMedia = 64;
/// Highest power of r in an asphere.
inline constexpr int kMaxAspherePower = 40;

/// Index of refraction of each of Lens::media, for each lane's wavelength.
template <class V>
struct LensIndices {
    V of_medium[kMaxMedia];
};

/// Lens for tracing. Surfaces are counted from 0 at the scene's side; the vertex of the first is at
/// z = 0.
class Lens {
  public:
    /// Throws std::invalid_argument where there is no surface, not one stop, kMaxMedia glasses or
    /// more, a number that is not finite, or a power of an asphere that is not an integer from 2 to
    /// kMaxAspherePower.
    explicit Lens(Prescription);

    [[nodiscard]] const Prescription& prescription() const { return prescription_; }
    [[nodiscard]] int size() const { return static_cast<int>(vertices_mm_.size()); }
    [[nodiscard]] int last() const { return size() - 1; }
    [[nodiscard]] int stop() const { return stop_; }
    [[nodiscard]] double vertex_mm(int surface) const { return vertices_mm_[size_t(surface)]; }
    /// Film position of the prescription: behind the last thickness.
    [[nodiscard]] double film_mm() const;
    /// Moves what lies behind a surface to this distance from it; what is known of the glasses
    /// stays. Throws std::invalid_argument where it is not finite.
    void set_thickness(int surface, double mm);
    /// Whether the lens is the same at every azimuth: no cylinder.
    [[nodiscard]] bool of_revolution() const;
    /// Media: air, then each glass once.
    [[nodiscard]] const std::vector<Glass>& media() const { return media_; }

    /// Surfaces and aspheres for the trace. S: float or double.
    template <class S>
    [[nodiscard]] const std::vector<SurfaceFacts<S>>& surfaces() const;
    template <class S>
    [[nodiscard]] const std::vector<Asphere<S>>& aspheres() const;

    /// Indices by the glasses' own formulas, for analyses.
    [[nodiscard]] LensIndices<d4> exact_indices(d4 nm) const;
    /// The same indices in floats.
    [[nodiscard]] LensIndices<f4> exact_indices(f4 nm) const;
    [[nodiscard]] LensIndices<f8> exact_indices(f8 nm) const;
    /// Indices from tables of 1 nm that are linear in between, for rendering. For catalogue glasses
    /// they are within 3.5e-6 of the formula from 400 nm up, float's rounding included, and 1.2e-5
    /// from 360; in the nanometre where a glass's range begins within 2.1e-4, as the index has a
    /// kink there.
    [[nodiscard]] LensIndices<f4> indices(f4 nm) const;
    [[nodiscard]] LensIndices<f8> indices(f8 nm) const;

  private:
    template <class V>
    [[nodiscard]] LensIndices<V> from_tables(V nm) const;

    Prescription prescription_;
    int stop_ = 0;
    std::vector<double> vertices_mm_;
    std::vector<Glass> media_;
    std::vector<SpectrumTable> tables_;
    std::vector<SurfaceFacts<float>> surfaces_f_;
    std::vector<SurfaceFacts<double>> surfaces_d_;
    std::vector<Asphere<float>> aspheres_f_;
    std::vector<Asphere<double>> aspheres_d_;
};

template <>
inline const std::vector<SurfaceFacts<float>>& Lens::surfaces<float>() const {
    return surfaces_f_;
}
template <>
inline const std::vector<SurfaceFacts<double>>& Lens::surfaces<double>() const {
    return surfaces_d_;
}
template <>
inline const std::vector<Asphere<float>>& Lens::aspheres<float>() const {
    return aspheres_f_;
}
template <>
inline const std::vector<Asphere<double>>& Lens::aspheres<double>() const {
    return aspheres_d_;
}

}  // namespace petzval::camera
