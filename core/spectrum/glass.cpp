// SPDX-License-Identifier: Apache-2.0
#include "core/spectrum/glass.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace petzval {
namespace {

double index_of(const Sellmeier& formula, double um) {
    const double w2 = um * um;
    double n2 = 1 + formula.constant;
    for (const auto& [b, c] : formula.terms) n2 += b * w2 / (w2 - c);
    return std::sqrt(n2);
}

double sum_of_powers(const std::vector<std::array<double, 2>>& terms, double um) {
    double sum = 0;
    for (const auto& [a, power] : terms) sum += a * std::pow(um, power);
    return sum;
}

double index_of(const PowerSeries& formula, double um) {
    return std::sqrt(sum_of_powers(formula.terms, um));
}

double index_of(const IndexSeries& formula, double um) {
    return sum_of_powers(formula.terms, um);
}

// Value at nm of points joined by straight lines; held beyond their ends. At least one.
double joined(const std::vector<std::array<double, 2>>& points, double nm) {
    const auto next = std::upper_bound(points.begin(), points.end(), nm,
                                       [](double x, const auto& point) { return x < point[0]; });
    if (next == points.begin()) return points.front()[1];
    if (next == points.end()) return points.back()[1];
    const double t = (nm - next[-1][0]) / ((*next)[0] - next[-1][0]);
    return next[-1][1] * (1 - t) + (*next)[1] * t;
}

double index_of(const IndexTable& table, double um) {
    return joined(table.points, um * 1e3);
}

}  // namespace

double Glass::index(double nm) const {
    const double um = std::clamp(nm, first_nm, last_nm) * 1e-3;
    return std::visit([um](const auto& kind) { return index_of(kind, um); }, formula);
}

f4 Glass::index(f4 nm) const {
    f4 n{};
    for (int i = 0; i < 4; ++i) n[i] = static_cast<float>(index(double(nm[i])));
    return n;
}

double Glass::absorption(double nm) const {
    return absorption_per_mm.empty() ? 0 : joined(absorption_per_mm, nm);
}

double Glass::abbe() const {
    const double spread = index(kLineF_nm) - index(kLineC_nm);
    if (spread == 0) return std::numeric_limits<double>::infinity();
    return (index(kLineD_nm) - 1) / spread;
}

IndexSeries cauchy_through(double nd, double abbe) {
    const auto per_um2 = [](double nm) { return 1e6 / (nm * nm); };
    const double b = (nd - 1) / abbe / (per_um2(kLineF_nm) - per_um2(kLineC_nm));
    return {{{nd - b * per_um2(kLineD_nm), 0}, {b, -2}}};
}

IndexSeries glass_like(double nd, double abbe) {
    if (std::isinf(abbe)) return {{{nd, 0}}};
    const auto power = [](double nm, double p) { return std::pow(nm * 1e-3, p); };
    const auto between = [&power](double nm1, double nm2, double p) {
        return power(nm1, p) - power(nm2, p);
    };
    const double nF_nC = (nd - 1) / abbe;
    const double ng_nF = (0.505549 - 0.000142809 * abbe + 2.8816 / abbe) * nF_nC;
    const double b1 = between(kLineF_nm, kLineC_nm, -1.5), c1 = between(kLineF_nm, kLineC_nm, -4.5);
    const double b2 = between(kLineG_nm, kLineF_nm, -1.5), c2 = between(kLineG_nm, kLineF_nm, -4.5);
    const double determinant = b1 * c2 - b2 * c1;
    const double b = (nF_nC * c2 - ng_nF * c1) / determinant;
    const double c = (b1 * ng_nF - b2 * nF_nC) / determinant;
    return {
        {{nd - b * power(kLineD_nm, -1.5) - c * power(kLineD_nm, -4.5), 0}, {b, -1.5}, {c, -4.5}}};
}

}  // namespace petzval
