#include "transport/path/spot_trial.h"

#include <math.h>
#include <stdbool.h>

/* What scattering finds alone, and what is left where both share by the power heuristic,
   is known for each place that was looked at. */
void spot_trial_note(spot_trial *trial, const spot_look *look)
{
    double p = look->pdf, q = look->pdf_scatter;
    double x2 = trial->weight * look->value * p * look->value * p;
    if (!isfinite(x2) || !(q > 0.0) || !(p > 0.0))
        return;
    trial->without += x2 / q / p;
    for (int i = 0; i < N_SHARES; i++) {
        double looked = p * look->importance * plan_share(i);
        double w = q * q / (q * q + looked * looked);
        trial->with[i] += x2 * (w * w / q + (1.0 - w) * (1.0 - w) / looked) / p;
    }
}

void spot_trial_add(spot_trial *trial, const spot_trial *other)
{
    trial->rays += other->rays;
    trial->without += other->without;
    for (int i = 0; i < N_SHARES; i++)
        trial->with[i] += other->with[i];
}
