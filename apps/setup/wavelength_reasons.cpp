// SPDX-License-Identifier: Apache-2.0
#include "apps/setup/wavelength_reasons.h"

#include <fmt/format.h>

#include <set>

namespace petzval {
namespace {

/// Things of one kind: the first of them in words, and how many there are.
class Kind {
  public:
    template <class Describe>
    void add(const Describe& describe) {
        if (count_++ == 0) first_ = describe();
    }
    void append_to(std::vector<std::string>& reasons) const {
        if (count_ > 1) reasons.push_back(fmt::format("{}, and {} more", first_, count_ - 1));
        if (count_ == 1) reasons.push_back(first_);
    }

  private:
    std::string first_;
    size_t count_ = 0;
};

std::string named(const Material& material) {
    return material.name.empty() ? "a material without a name"
                                 : fmt::format("material \"{}\"", material.name);
}

bool disperses(const Material& m) {
    return m.glass && m.refracts();
}

int32_t illuminant_of(const Light& light) {
    const auto of = [](const auto& l) -> int32_t {
        if constexpr (requires { l.illuminant; }) return l.illuminant;
        return -1;
    };
    return std::visit(of, light);
}

bool is_known(const Glass& glass, double first_nm, double last_nm) {
    return glass.first_nm <= first_nm && glass.last_nm >= last_nm;
}

std::string range_of(const Glass& glass) {
    return fmt::format("glass {} is known from {:g} to {:g} nm", glass.name, glass.first_nm,
                       glass.last_nm);
}

}  // namespace

std::vector<std::string> reasons_for_wavelengths(const Scene& scene) {
    Kind glasses, metals, emitters, lights;
    for (const Material& m : scene.materials) {
        if (disperses(m))
            glasses.add([&] { return fmt::format("{} disperses ({})", named(m), m.glass->name); });
        if (m.metal >= 0 && m.metallic > 0)
            metals.add([&] {
                return fmt::format("{} is a measured metal ({})", named(m),
                                   scene.metals[static_cast<size_t>(m.metal)].name);
            });
        if (const Illuminant* white = scene.illuminant(m.illuminant); white && m.emits())
            emitters.add(
                [&] { return fmt::format("{} shines as illuminant {}", named(m), white->name); });
    }
    for (const Light& light : scene.lights)
        if (const Illuminant* white = scene.illuminant(illuminant_of(light)))
            lights.add([&] { return fmt::format("a light shines as illuminant {}", white->name); });
    std::vector<std::string> reasons;
    for (const Kind* kind : {&glasses, &metals, &emitters, &lights}) kind->append_to(reasons);
    return reasons;
}

std::vector<std::string> glass_range_warnings(const Scene& scene) {
    std::vector<std::string> warnings;
    std::set<std::string> seen;
    for (const Material& m : scene.materials)
        if (disperses(m) && !is_known(*m.glass, kFirst_nm, kLast_nm) &&
            seen.insert(m.glass->name).second)
            warnings.push_back(range_of(*m.glass) + ": the value at the end is held outside");
    return warnings;
}

std::optional<std::string> glass_beyond(const Scene& scene, double first_nm, double last_nm) {
    for (const Material& m : scene.materials)
        if (disperses(m) && !is_known(*m.glass, first_nm, last_nm))
            return fmt::format("{}, not from {:g} to {:g} nm", range_of(*m.glass), first_nm,
                               last_nm);
    return std::nullopt;
}

}  // namespace petzval
