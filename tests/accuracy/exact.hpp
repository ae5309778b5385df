// The slow half of the oracle, which cannot err: Sturm's theorem on the very inputs as fractions.
#pragma once

#include <boost/multiprecision/cpp_int.hpp>

#include "accuracy/disc_oracle.hpp"
#include "core/sturm.hpp"

namespace carom::accuracy {

using Rational = boost::multiprecision::number<
    boost::multiprecision::rational_adaptor<boost::multiprecision::cpp_int_backend<>>,
    boost::multiprecision::et_off>;
using RationalPolynomial = std::vector<Rational>;

/// |r + v t + a t^2 / 2|^2 - s^2, exactly; without trailing zeros.
RationalPolynomial exact_gap(const DiscQuery& q);

/// The sign of |r|^2 - s^2.
int exact_sign_of_gap(const DiscQuery& q);

/// The answer by the event rule, its time to 1e-33.
Truth exact_truth(const DiscQuery& q);

/// Does the first impact lie within `slack` of `time`, or is there surely none? Counts roots, shares nothing
/// with how `truth` was found.
bool confirms(const DiscQuery& q, const Truth& truth, Wide slack);

}  // namespace carom::accuracy
