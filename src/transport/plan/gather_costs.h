/*
 * What the trial of gathering says of a picture: its error and its price.
 */
#pragma once

#include "transport/plan/gather_trial.h"

/** @brief Squared error of the picture times the samples of a pixel, and rays of a
 * sample with its share of a pass' photons.
 *  @param without by paths, as the plan is @param with by maps
 *  @return whether as much as half a pass by maps fits into the work of paths */
bool gather_costs(const transport_plan *plan, const gather_trial *t, plan_cost *without,
                  plan_cost *with);
