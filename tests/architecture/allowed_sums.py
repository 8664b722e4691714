"""What sums.py finds and is right, with the reason. An entry that finds nothing any more must go."""

from sums import Allowed

_GEOMETRY = "geometry of the specimen, on one thread, before there is a body"
_ZONE = "inside one zone"
_FACE = "inside one row of faces: its contact points, components or sides"
_BUNDLE = "of one bundle, in the step; chunked_sum takes the bundles"
_GRIDPOINT = "at one gridpoint, from what touches it, in the order of the contacts or zones"
_NODE = "at one node, from what shares it, in one order"
_TIE = "over the gridpoints of one tie, in the order that it was made with"

ALLOWED = [
    # Not over a body
    Allowed("app/check.cpp", "", "over the stages of a deck"),
    Allowed("base/chunked_sum.hpp", "total += sum;", "chunked_sum itself"),
    Allowed("base/vec.hpp", "", "components of one vector"),
    Allowed("material/creep.cpp", "", "components of one tensor"),
    Allowed("material/mixture.cpp", "", "over the phases of a composite"),
    Allowed("simulation/heat_conditions.cpp", "with_specimen()", "over the phases of a specimen"),
    Allowed("base/team.cpp", "", "times that threads waited, in whole nanoseconds"),
    Allowed("session/law_point.cpp", "LawPoint::dissipated()", "over the losses of one contact point"),
    Allowed("mechanics/mechanics.cpp", "Dissipation::total()", "over the energies of one ledger, each a chunked sum"),
    Allowed("*", "exposure()", "durations of the stages of a deck"),
    Allowed("*response.cpp", "fit()", "over the rows of a history"),
    Allowed("results/field_files.cpp", "frame_times()", "over the frames of a run"),
    Allowed("results/summary.cpp", "energy_error()", "over the columns of energies in one row of a history"),
    Allowed("simulation/press.cpp", "Press::lateral_strain()", "over the directions across the press"),
    Allowed("stages/record_results.cpp", "work()", "over the rows of a history"),
    Allowed("stages/exchange_stage.cpp", "exchange_response()", "over the rows of a history"),
    Allowed("stages/expose.cpp", "Expose::foreseen_change()", "over the stages of a deck"),
    Allowed("thermal/time_stages.cpp", "set_weights()", "over the stages of one time step"),
    Allowed("thermal/heat_boundary.cpp", "part(sum, c) += of_entry", "over the boundary conditions of a deck"),
    Allowed("thermal/heat_material.cpp", "HeatTable::extend()", "over the knots of a table"),
    # Before there is a body
    Allowed("specimen/*", "", _GEOMETRY),
    Allowed("*", "estimate_modulus()", "an estimate for the screen, on one thread, from the model as built"),
    Allowed("mechanics/layout.cpp", "order_blocks()", "centre of one block"),
    Allowed("model/outline.cpp", "outline()", "centre of one face"),
    Allowed("model/sets.cpp", "tributary_areas()", _GRIDPOINT),
    Allowed("model/sets.cpp", "centroids()", "over the zones of one block"),
    Allowed("simulation/loads.cpp", "Loads::forces()", _GRIDPOINT),
    Allowed("simulation/loads.cpp", "Loads::apply()", "at one gridpoint, over the sets that are loaded, by their names"),
    Allowed("stages/drive.cpp", "Drive::act()", "on one set, over the drives of a stage"),
    Allowed("stages/drive.cpp", "Drive::unit_force()", "over the drives of a stage"),
    Allowed("model/model.cpp", "face_frame()", "corners of one face"),
    # Inside one item
    Allowed("laws/*", "", "inside one contact point"),
    Allowed("material/zone_law.hpp", "", _ZONE),
    Allowed("*probe.cpp", "", _ZONE),
    Allowed("model/outline.cpp", "opposite_gradient()", _ZONE),
    Allowed("thermal/zone_conduction.cpp", "gradient[Dim] -=", _ZONE),
    Allowed("thermal/zone_conduction.cpp", "row[i] +=", _ZONE),
    Allowed("thermal/zone_conduction.cpp", "ZoneConduction::mean_temperature()", _ZONE),
    Allowed("thermal/zone_conduction.cpp", "ZoneConduction::update()", _ZONE),
    Allowed("thermal/zone_conduction.cpp", "ZoneConduction::inflow()", _NODE),
    Allowed("thermal/zone_conduction.cpp", "ZoneConduction::gather_rows()", _NODE),
    Allowed("thermal/zone_conduction.cpp", "ZoneConduction::shares()", _NODE),
    Allowed("thermal/conduction.cpp", "total_volumes()", _NODE),
    Allowed("thermal/conduction.cpp", "Conduction::move_heat_to()", _NODE),
    Allowed("thermal/conduction.cpp", "Conduction::gridpoint_shares()", _GRIDPOINT),
    Allowed("thermal/gap_conduction.cpp", "GapConduction::inflow()", _NODE),
    Allowed("thermal/conduction.cpp", "area[nodes_.of_gridpoint[g]] +=", _NODE),
    Allowed("thermal/heat_boundary.cpp", "heat[patch.node] +=", _NODE),
    Allowed("thermal/heat_boundary.cpp", "HeatBoundary::add_slope()", _NODE),
    Allowed("thermal/heat_material.cpp", "NodeEnthalpy::at()", _NODE),
    Allowed("thermal/heat_material.cpp", "NodeEnthalpy::least_capacity()", _NODE),
    Allowed("mechanics/mechanics.cpp", "gravity_mass_[g] +=", _GRIDPOINT),
    # The step
    Allowed("mechanics/step/*", "force[Dim] -= force[n]", _ZONE),
    Allowed("mechanics/step/*", "applied += norm(f)", _ZONE),
    Allowed("mechanics/step/*", "g[Dim] - vectors[n]", _ZONE),
    Allowed("mechanics/step/*", "sum += abs(k)", _ZONE),
    Allowed("mechanics/step/*", "force += frame.tangents[t]", _FACE),
    Allowed("mechanics/step/*", "turning += response.", _FACE),
    Allowed("mechanics/step/*", "stored += response.stored", _FACE),
    Allowed("mechanics/step/*", "applied += 2.0 * norm(force)", _FACE),
    Allowed("mechanics/step/*", "sum += abs(k.normal", _FACE),
    Allowed("mechanics/step/*", "area += Real::load(", _FACE),
    Allowed("mechanics/step/*", "total[i] += select(side_b", _GRIDPOINT),
    Allowed("mechanics/step/*", "gather(s.turning_force", _GRIDPOINT),
    Allowed("mechanics/step/*", "total += force;", _GRIDPOINT),
    Allowed("mechanics/step/*", "middle += more[2]", _GRIDPOINT),
    Allowed("mechanics/step/*", "scratch.sum[slot / kLanes].c[i][slot % kLanes] +=", _GRIDPOINT),
    Allowed("mechanics/step/*", "sums.applied += norm(", _BUNDLE),
    Allowed("mechanics/step/*", "sums.stored -=", _BUNDLE),
    Allowed("mechanics/step/*", "sums.applied += select(", _BUNDLE),
    Allowed("mechanics/step/*", "move_row()", _BUNDLE),
    Allowed("mechanics/step/*", "loading_work +=", _BUNDLE),
    Allowed("mechanics/step/*", "total += force(slot)", _TIE),
    Allowed("mechanics/step/*", "mass += s.time_step / s.step_over_mass[slot]", _TIE),
    Allowed("mechanics/mechanics.cpp", "Mechanics::tie()", _TIE),
]
