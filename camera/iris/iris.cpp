// SPDX-License-Identifier: Apache-2.0
// Points of an iris, drawn by random numbers.
#include "camera/iris/iris.h"

namespace petzval::camera {
namespace {

// Points to try. The first is u itself: what is accepted of a stratified set stays stratified. The
// last is a hash too, because a u that was refused says where it is not, and is no longer uniform.
class Candidates {
  public:
    explicit Candidates(V2f u)
        : u_(u), key_(hash32(std::bit_cast<uint32_t>(u.x), std::bit_cast<uint32_t>(u.y))) {}
    V2f next2() {
        if (count_ == 0) return ++count_, u_;
        const float x = next();
        return {x, next()};
    }
    float next() { return to_unit_float(hash32(key_, count_++)); }

  private:
    V2f u_;
    uint32_t key_, count_ = 0;
};

}  // namespace

V2f Iris::Round::draw(V2f u) const {
    return uniform_disk(u) * radius;
}

template <class Drawn>
V2f Iris::reject(const Drawn& shape, V2f u) {
    Candidates candidates(u);
    const V2f lower = shape.lower(), size = shape.size();
    for (int i = 0; i < kTries; ++i) {
        const V2f p = lower + size * candidates.next2();
        const float transmission = shape.transmits(p);
        if (transmission == shape.peak() ||
            (transmission > 0.f && candidates.next() * shape.peak() < transmission))
            return p;
    }
    return shape.draw(candidates.next2());
}

V2f Iris::sample_whole(V2f u) const {
    return std::visit(
        [&](const auto& shape) { return rejection_ ? reject(shape, u) : shape.draw(u); }, shape_);
}

V2f Iris::sample(V2f u) const {
    V2f p = sample_whole(u);
    if (!cut_ || within_rim(p)) return p;
    Candidates candidates(u);
    static_cast<void>(candidates.next2());  // u itself
    for (int i = 1; i < kTries && !within_rim(p); ++i) p = sample_whole(candidates.next2());
    return p;
}

}  // namespace petzval::camera
