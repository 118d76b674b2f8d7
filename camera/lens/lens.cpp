// SPDX-License-Identifier: Apache-2.0
#include "camera/lens/lens.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

namespace petzval::camera {
namespace {

[[noreturn]] void refuse(size_t surface, const char* what) {
    throw std::invalid_argument("lens surface " + std::to_string(surface) + " " + what);
}

void check(const LensSurface& surface, size_t i) {
    for (const double number :
         {surface.curvature_1_mm, surface.conic, surface.thickness_mm, surface.semi_diameter_mm})
        if (!std::isfinite(number)) refuse(i, "has a number that is not finite");
    for (const auto& [power, coefficient] : surface.asphere) {
        if (!(power >= 2 && power <= kMaxAspherePower && power == std::floor(power)))
            refuse(i, "has an asphere with a power that is not an integer from 2 to 40");
        if (!std::isfinite(coefficient)) refuse(i, "has a number that is not finite");
    }
}

Asphere<double> asphere_of(const LensSurface& surface) {
    Asphere<double> out;
    out.curvature = surface.curvature_1_mm;
    out.one_plus_k = 1 + surface.conic;
    out.across_x = surface.profile != Profile::CylinderX;
    out.across_y = surface.profile != Profile::CylinderY;
    for (const auto& [power, coefficient] : surface.asphere) {
        const int n = static_cast<int>(power);
        auto& terms = n % 2 ? out.odd : out.even;
        const auto place = static_cast<size_t>((n - 2) / 2);
        if (terms.size() <= place) terms.resize(place + 1);
        terms[place] += coefficient;
    }
    return out;
}

SurfaceFacts<double> facts_of(const LensSurface& surface) {
    SurfaceFacts<double> out;
    const double c = surface.curvature_1_mm;
    out.curvature_x = surface.profile == Profile::CylinderX ? 0 : c;
    out.curvature_y = surface.profile == Profile::CylinderY ? 0 : c;
    out.curvature_z = (1 + surface.conic) * c;
    out.gap_mm = surface.thickness_mm;
    out.semi_diameter2_mm2 = surface.semi_diameter_mm * surface.semi_diameter_mm;
    if (!surface.asphere.empty())
        out.shape = Shape::Asphere;
    else if (c != 0 && (surface.conic != 0 || surface.profile != Profile::Rotational))
        out.shape = Shape::Quadric;
    return out;
}

SurfaceFacts<float> in_floats(const SurfaceFacts<double>& a) {
    return {float(a.curvature_x),
            float(a.curvature_y),
            float(a.curvature_z),
            float(a.gap_mm),
            float(a.semi_diameter2_mm2),
            a.shape,
            a.medium_before,
            a.medium_after,
            a.asphere};
}

Asphere<float> in_floats(const Asphere<double>& a) {
    return {float(a.curvature),
            float(a.one_plus_k),
            float(a.across_x),
            float(a.across_y),
            {a.even.begin(), a.even.end()},
            {a.odd.begin(), a.odd.end()}};
}

SpectrumTable table_of(const Glass& glass) {
    SpectrumTable out;
    for (int nm = kFirst_nm; nm <= kLast_nm; ++nm)
        out.at_nm(nm) = static_cast<float>(glass.index(double(nm)));
    return out;
}

}  // namespace

Lens::Lens(Prescription prescription) : prescription_(std::move(prescription)) {
    const auto& surfaces = prescription_.surfaces;
    if (surfaces.empty()) throw std::invalid_argument("the lens has no surface");
    if (std::count_if(surfaces.begin(), surfaces.end(), [](auto& s) { return s.stop; }) != 1)
        throw std::invalid_argument("the lens must have one stop");
    media_.push_back({"air", IndexSeries{{{1, 0}}}});
    double z_mm = 0;
    for (size_t i = 0; i < surfaces.size(); ++i) {
        const LensSurface& surface = surfaces[i];
        check(surface, i);
        if (surface.stop) stop_ = static_cast<int>(i);
        vertices_mm_.push_back(z_mm);
        z_mm += surface.thickness_mm;

        auto facts = facts_of(surface);
        facts.medium_before = i == 0 ? uint8_t{0} : surfaces_d_.back().medium_after;
        if (surface.glass) {
            const auto at = std::find(media_.begin() + 1, media_.end(), *surface.glass);
            facts.medium_after = static_cast<uint8_t>(at - media_.begin());
            if (at == media_.end()) media_.push_back(*surface.glass);
            if (media_.size() > kMaxMedia) throw std::invalid_argument("too many glasses");
        }
        if (facts.shape == Shape::Asphere) {
            facts.asphere = static_cast<uint16_t>(aspheres_d_.size());
            aspheres_d_.push_back(asphere_of(surface));
            aspheres_f_.push_back(in_floats(aspheres_d_.back()));
        }
        surfaces_d_.push_back(facts);
        surfaces_f_.push_back(in_floats(facts));
    }
    for (const Glass& glass : media_) tables_.push_back(table_of(glass));
}

double Lens::film_mm() const {
    return vertices_mm_.back() + prescription_.surfaces.back().thickness_mm;
}

bool Lens::of_revolution() const {
    return std::all_of(prescription_.surfaces.begin(), prescription_.surfaces.end(),
                       [](const LensSurface& s) { return s.profile == Profile::Rotational; });
}

void Lens::set_thickness(int surface, double mm) {
    const auto i = static_cast<size_t>(surface);
    if (!std::isfinite(mm)) refuse(i, "has a number that is not finite");
    prescription_.surfaces[i].thickness_mm = mm;
    surfaces_d_[i].gap_mm = mm;
    surfaces_f_[i].gap_mm = float(mm);
    for (size_t k = i + 1; k < vertices_mm_.size(); ++k)
        vertices_mm_[k] = vertices_mm_[k - 1] + prescription_.surfaces[k - 1].thickness_mm;
}

LensIndices<d4> Lens::exact_indices(d4 nm) const {
    LensIndices<d4> out;
    for (size_t i = 0; i < media_.size(); ++i)
        for (int lane = 0; lane < 4; ++lane) out.of_medium[i][lane] = media_[i].index(nm[lane]);
    return out;
}

LensIndices<f4> Lens::exact_indices(f4 nm) const {
    LensIndices<f4> out;
    for (size_t i = 0; i < media_.size(); ++i) out.of_medium[i] = media_[i].index(nm);
    return out;
}

LensIndices<f8> Lens::exact_indices(f8 nm) const {
    const LensIndices<f4> low = exact_indices(__builtin_shufflevector(nm, nm, 0, 1, 2, 3)),
                          high = exact_indices(__builtin_shufflevector(nm, nm, 4, 5, 6, 7));
    LensIndices<f8> out;
    for (size_t i = 0; i < media_.size(); ++i)
        out.of_medium[i] = joined(low.of_medium[i], high.of_medium[i]);
    return out;
}

template <class V>
LensIndices<V> Lens::from_tables(V nm) const {
    // Interpolation as in SpectrumTable::at, but the place in the tables is looked for once.
    const V last = broadcast<V>(kSpectrumSize - 1), least = nm - float(kFirst_nm);
    const V place = select(least > 0, select(least < last, least, last), V{});
    const MaskOf<V> i =
        __builtin_convertvector(select(place < last - 1, place, V(last - 1)), MaskOf<V>);
    const V t = place - __builtin_convertvector(i, V);
    LensIndices<V> out;
    for (size_t k = 0; k < tables_.size(); ++k) {
        const float* at = tables_[k].value.data();
        V below, above;
        for (int lane = 0; lane < NumberTraits<V>::lanes; ++lane) {
            below[lane] = at[i[lane]];
            above[lane] = at[i[lane] + 1];
        }
        out.of_medium[k] = below * (1 - t) + above * t;
    }
    return out;
}

LensIndices<f4> Lens::indices(f4 nm) const {
    return from_tables(nm);
}

LensIndices<f8> Lens::indices(f8 nm) const {
    return from_tables(nm);
}

}  // namespace petzval::camera
