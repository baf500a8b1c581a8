// Names of what a row holds: the trial writes, the summary reads.
#pragma once

namespace fatmc::dynamics_change {

// One value an epoch, epochs `kEpoch` s apart, the first after one epoch.
inline constexpr const char* kCslSsv =
    "p_total_ssv";  ///< confident stability level (T 2.273), by the rule of the spec
inline constexpr const char* kRobustSsv = "p_band_ssv";    ///< without the gates of nominal stability and SNR
inline constexpr const char* kNominal = "nominal_stable";  ///< 1: at every line
/// Mean over the lines of ln of the output noise, C_V_noise,ii (ln of rad^2/s^2), of p, q, r.
inline constexpr const char* kNoise[] = {"noise_p", "noise_q", "noise_r"};

// Metrics.
inline constexpr const char* kEpoch = "epoch_s";
inline constexpr const char* kWindow = "window_s";
inline constexpr const char* kOnset = "onset_s";        ///< of the change; infinite: none
inline constexpr const char* kDuration = "duration_s";  ///< over which it comes about
inline constexpr const char* kStrength = "strength";    ///< of the first effect; NaN: none
inline constexpr const char* kFlown = "flown_s";        ///< until the end or the divergence

}  // namespace fatmc::dynamics_change
