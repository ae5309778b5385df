// A disc in one line.
#pragma once

#include <carom/core/impact.hpp>

namespace carom::test {

inline Disc<double> disc(const Vec2& p, const Vec2& v, double radius, double mass = 1, double e = 1,
                         const Vec2& a = {0, 0}) {
    return {{p, v, a}, radius, mass, e};
}

}  // namespace carom::test
