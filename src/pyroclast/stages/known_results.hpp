#pragma once

#include "pyroclast/simulation/loop/stage.hpp"

/// Results of the program's own stages: each name, unit and meaning stands here once.
namespace pyroclast::known {

inline constexpr const char* kStrain = "1e-3";  ///< how a reader sees a strain

// compression
inline constexpr ResultInfo modulus{"E_GPa", "GPa", "E", "modulus of elasticity", ResultOf::test, 1};
inline constexpr ResultInfo toe_strain{"toe_strain", "1", "toe",
                                       "strain up to which the curve is less steep than where E is fitted"};
inline constexpr ResultInfo strain_at_peak{
    "strain_at_peak", "1", "strain at the peak", "strain at f_c", ResultOf::test, 2, kStrain};
inline constexpr ResultInfo by_small_fall{"f_c_by_fall_of_2_percent_MPa", "MPa", "f_c by a fall of 2 %",
                                          "stress at the first peak behind which the stress falls by 2 %"};
inline constexpr ResultInfo by_large_fall{"f_c_by_fall_of_10_percent_MPa", "MPa", "f_c by a fall of 10 %",
                                          "stress at the first peak behind which the stress falls by 10 %"};
inline constexpr ResultInfo stress_max{"stress_max_MPa", "MPa", "largest stress",
                                       "largest stress of the stage"};
inline constexpr ResultInfo strain_at_stress_max{"strain_at_stress_max",
                                                 "1",
                                                 "strain at the largest stress",
                                                 "strain at the largest stress of the stage",
                                                 ResultOf::test,
                                                 kAnyDigits,
                                                 kStrain};
inline constexpr ResultInfo inelastic_strain{
    "strain_ic",    "1", "ε_ic", "inelastic strain at the peak: strain there less f_c over E",
    ResultOf::test, 2,   kStrain};
inline constexpr ResultInfo unloading_modulus{"E_unloading_GPa", "GPa", "E in unloading",
                                              "slope of the curve while the platen goes back"};
inline constexpr ResultInfo stress_at_end{"stress_at_end_MPa", "MPa", "stress at the end",
                                          "stress at the end of the stage"};
inline constexpr ResultInfo quasi_static{"quasi_static", "1", "quasi-static",
                                         "whether inertia changed the curve up to the peak by little",
                                         ResultOf::computation};
inline constexpr ResultInfo quasi_static_after_peak{"quasi_static_after_peak", "1",
                                                    "quasi-static after the peak", "the same after the peak",
                                                    ResultOf::computation};
inline constexpr ResultInfo kinetic_to_peak{
    "kinetic_over_elastic_to_peak", "1", "kinetic over elastic energy",
    "largest kinetic over elastic energy up to the peak", ResultOf::computation};
inline constexpr ResultInfo kinetic_after_peak{"kinetic_over_elastic_after_peak", "1",
                                               "kinetic over elastic energy after the peak",
                                               "the same after the peak", ResultOf::computation};
inline constexpr ResultInfo difference_to_peak{
    "platen_difference_over_f_c_to_peak", "1", "difference of the platens",
    "largest difference of the platens' stresses over f_c up to the peak", ResultOf::computation};
inline constexpr ResultInfo difference_after_peak{"platen_difference_over_f_c_after_peak", "1",
                                                  "difference of the platens after the peak",
                                                  "the same after the peak", ResultOf::computation};

// load
inline constexpr ResultInfo load_stress{
    "load_stress_MPa", "MPa", "stress while heated", "stress that the load brings", ResultOf::computation, 1};
inline constexpr ResultInfo load_level{
    "load_level", "1", "load level", "stress of the load over f_c", ResultOf::computation, 2, "of f_c"};
inline constexpr ResultInfo strength_of_level{"f_c_of_level_MPa", "MPa", "f_c of the load level",
                                              "f_c of which the load level is a share",
                                              ResultOf::computation};
inline constexpr ResultInfo strength_of_level_is{"f_c_of_level_is", "", "source of this f_c",
                                                 "what that f_c is of", ResultOf::computation};
inline constexpr ResultInfo largest_stress{"largest_stress_MPa", "MPa", "largest stress",
                                           "largest stress that the specimen bore"};
inline constexpr ResultInfo strain{
    "strain", "1", "strain", "strain at the end of the stage", ResultOf::computation, kAnyDigits, kStrain};

// all that come to rest
inline constexpr ResultInfo steps{"steps", "1", "steps", "steps of the stage", ResultOf::computation};
inline constexpr ResultInfo unbalanced_ratio{"unbalanced_ratio", "1", "unbalanced ratio",
                                             "unbalanced forces over all forces at the end",
                                             ResultOf::computation};

// exchanges of temperatures
inline constexpr ResultInfo field{"field", "", "temperatures", "\"uniform\", or \"conduction\": computed",
                                  ResultOf::computation};
inline constexpr ResultInfo platen{"platen", "", "platen", "how the platen is held: \"force\" or \"fixed\"",
                                   ResultOf::computation};
inline constexpr ResultInfo critical_temperature{
    "critical_temperature_degC",
    "degC",
    "critical temperature",
    "mean temperature at which the specimen failed under its load",
    ResultOf::test,
    0};
inline constexpr ResultInfo critical_time{"critical_time_s", "s", "critical time",
                                          "time since heating began at which the specimen failed"};
inline constexpr ResultInfo answer_is{"answer_is", "", "of what this is the answer",
                                      "body and conditions for which the critical temperature is one",
                                      ResultOf::computation};
inline constexpr ResultInfo highest_temperature{
    "highest_temperature_degC", "degC", "highest temperature", "highest temperature of the specimen",
    ResultOf::computation,      0};
inline constexpr ResultInfo largest_increment{"largest_exchange_increment_K", "K", "largest increment",
                                              "largest change of temperature of an exchange",
                                              ResultOf::computation};
inline constexpr ResultInfo exchanges{"exchanges", "1", "exchanges", "number of exchanges of temperatures",
                                      ResultOf::computation};
inline constexpr ResultInfo exchanges_not_converged{"exchanges_not_converged", "1", "exchanges not at rest",
                                                    "exchanges after which the body did not come to rest",
                                                    ResultOf::computation};
inline constexpr ResultInfo worst_unbalanced_ratio{"worst_unbalanced_ratio", "1", "worst unbalanced ratio",
                                                   "largest unbalanced ratio after an exchange",
                                                   ResultOf::computation};
inline constexpr ResultInfo cycles{"cycles", "1", "cycles", "steps of all exchanges", ResultOf::computation};
inline constexpr ResultInfo largest_thrust{
    "largest_thrust_MPa", "MPa", "largest thrust", "largest stress between the platens", ResultOf::test, 1};

// conduction
inline constexpr ResultInfo steady{"steady", "1", "steady", "whether the temperatures no longer changed"};
inline constexpr ResultInfo heating_time{"heating_time_s", "s", "heating time", "time since heating began",
                                         ResultOf::computation};
inline constexpr ResultInfo largest_pore_pressure{
    "largest_pore_pressure_MPa", "MPa", "largest pore pressure",
    "largest pressure of the vapour in pores, less that of the atmosphere"};
inline constexpr ResultInfo time_of_largest_pore_pressure{"time_of_largest_pore_pressure_s", "s",
                                                          "time of it", "heating time of that pressure"};
inline constexpr ResultInfo largest_pressure_ratio{
    "largest_pore_pressure_over_saturation", "1", "largest pressure over saturation",
    "largest pressure of the vapour over that above water of the same temperature"};
inline constexpr ResultInfo water_left{"water_left_kg", "kg", "water lost",
                                       "water that left the specimen since the start"};
inline constexpr ResultInfo temperature_mean{"temperature_mean_degC", "degC", "mean temperature",
                                             "mean temperature over the volume"};
inline constexpr ResultInfo temperature_min{"temperature_min_degC", "degC", "lowest temperature",
                                            "lowest temperature of the specimen"};
inline constexpr ResultInfo temperature_max{"temperature_max_degC", "degC", "highest temperature",
                                            "highest temperature of the specimen"};
inline constexpr ResultInfo rate{"rate_K_s", "K/s", "rate", "rate at which temperatures still change"};

// drives
inline constexpr ResultInfo loading_work{"loading_work_J", "J", "loading_work", "work of the loads",
                                         ResultOf::computation};
inline constexpr ResultInfo largest_load_factor{"largest_load_factor", "1", "largest_load_factor",
                                                "largest share of the loads that the control let act"};
inline constexpr ResultInfo control_force{"control_force_over_peak", "1", "control_force_over_peak",
                                          "largest force of the control's pair over the largest load",
                                          ResultOf::computation};
inline constexpr ResultInfo load_with_control{"largest_load_with_control_N", "N", "largest_load_with_control",
                                              "largest load with the force of the control's pair"};
inline constexpr ResultInfo control_error{
    "control_error_of_largest_load", "1", "control_error_of_largest_load",
    "share by which that force raises the largest load", ResultOf::computation};
inline constexpr ResultInfo control_work{
    "control_work_over_loading_work", "1", "control_work_over_loading_work",
    "work of the control's pair over the work of the loads", ResultOf::computation};

}  // namespace pyroclast::known
