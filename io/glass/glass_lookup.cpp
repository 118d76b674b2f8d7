// SPDX-License-Identifier: Apache-2.0
#include "io/glass/glass_lookup.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "io/base/ascii.h"
#include "io/base/printable.h"
#include "io/glass/catalogue.h"

namespace petzval::io {

void LensGlasses::read_assets() {
    if (!assets_.empty()) return;
    for (Glass& glass : glass_catalog()) {
        std::string name = lower(glass.name);
        assets_.emplace(std::move(name), std::move(glass));
    }
}

std::optional<Glass> LensGlasses::find(const std::string& maker_and_name) {
    const std::string wanted = lower(maker_and_name);
    const size_t colon = wanted.find(':');
    if (colon == wanted.npos) return std::nullopt;
    for (const AgfCatalog& catalog : catalogs_)
        if (catalog.maker() == wanted.substr(0, colon))
            if (auto glass = catalog.find(wanted.substr(colon + 1))) return glass;
    read_assets();
    const auto at = assets_.find(wanted);
    return at == assets_.end() ? std::nullopt : std::optional(at->second);
}

std::vector<Glass> LensGlasses::of_any_maker(const std::string& name) {
    std::vector<Glass> out;
    for (const AgfCatalog& catalog : catalogs_)
        if (auto glass = catalog.find(name)) out.push_back(*std::move(glass));
    read_assets();
    const std::string ending = fmt::format(":{}", lower(name));
    for (const auto& [key, glass] : assets_)
        if (key.ends_with(ending)) out.push_back(glass);
    return out;
}

FoundGlass LensGlasses::named(const std::string& text) {
    if (auto glass = find(text)) return {std::move(glass), {}};
    std::vector<Glass> found = of_any_maker(text);
    if (found.size() == 1) return {std::move(found.front()), {}};
    std::vector<std::string> names =
        found.empty() ? glasses_near(text) : std::vector<std::string>();
    for (const Glass& glass : found) names.push_back(glass.name);
    return {{},
            fmt::format("{} \"{}\"{} {}", found.empty() ? "there is no glass" : "the glass",
                        printable(text),
                        found.empty() ? "; near are" : " has several makers: say which of",
                        fmt::join(names, ", "))};
}

Glass model_glass(double nd, double abbe) {
    return {fmt::format("{}/{}", nd, abbe), glass_like(nd, abbe)};
}

Glass constant_glass(double n) {
    return {fmt::format("{}", n), IndexSeries{{{n, 0}}}};
}

}  // namespace petzval::io
