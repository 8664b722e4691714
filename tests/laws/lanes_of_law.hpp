#pragma once

#include <algorithm>

#include "pyroclast/laws/kit.hpp"

namespace pyroclast {

/// A law through portable lanes, without the step: of a law whose rows are not compiled.
template <class Law, int Dim>
LanesResponse update_lanes(const void* constants, const double* own, const double* jump, double* internals,
                           double* losses) {
  using Real = Lanes<Portable>;
  using ForEach = typename Law::template Constants<Real>;
  struct alignas(64) Line {
    double number[kLanes];
  };
  struct Sum {
    Real number;
    void operator+=(const Real& more) { number += more; }
  };
  const auto load = [](const double* from) {
    Line line;
    std::copy_n(from, kLanes, line.number);
    return Real::load(line.number);
  };
  const auto store = [](const Real& number, double* to) {
    Line line;
    number.store(line.number);
    std::copy_n(line.number, kLanes, to);
  };
  typename Law::template Internals<Dim, Real> h;
  int at = 0;
  h.each([&](const auto&, Real& number) { number = load(internals + kLanes * at++); }, h);
  typename Law::template Losses<Sum> l;
  at = 0;
  l.each([&](const auto&, Sum& sum) { sum.number = load(losses + kLanes * at++); }, l);
  Tangential<Dim, Real> tangential;
  for (int i = 0; i + 1 < Dim; ++i) tangential[i] = load(jump + kLanes * (i + 1));
  const auto& of_all = *static_cast<const typename Law::template Constants<double>*>(constants);
  ContactResponse<Dim, Real> r;
  if (own) {
    ForEach c;
    ForEach::each_choice([](const auto&, auto& mine, const auto& of_set) { mine = of_set; }, c, of_all);
    at = 0;
    ForEach::each([&](const auto&, Real& number) { number = load(own + kLanes * at++); }, c);
    r = Law::template update<Dim>(c, load(jump), tangential, h, l);
  } else {
    r = Law::template update<Dim>(of_all, load(jump), tangential, h, l);
  }
  at = 0;
  h.each(
      [&](const InternalInfo& info, const Real& number) {
        if (info.when == 0 || (r.changed & info.when) != 0) store(number, internals + kLanes * at);
        ++at;
      },
      h);
  at = 0;
  l.each([&](const auto&, const Sum& sum) { store(sum.number, losses + kLanes * at++); }, l);
  LanesResponse response;
  store(r.normal_traction, response.normal_traction.data());
  for (int i = 0; i + 1 < Dim; ++i) store(r.shear_traction[i], response.shear_traction[i].data());
  store(r.stored, response.stored.data());
  response.changed = r.changed;
  return response;
}

template <class Law>
KitLanes lanes_of_law() {
  return {"portable lanes", {update_lanes<Law, 2>, update_lanes<Law, 3>}};
}

}  // namespace pyroclast
