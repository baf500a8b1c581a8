// Flights with effects in the signal path, in the airframe, or beginning in flight.
#include "core/flight/flight_loop.h"

namespace fatmc {

template void Flight::fly_plant(internal::LinearPlant, internal::ModifiedPath,
                                const Eigen::Ref<const Eigen::MatrixX3d>&, const TrialSeed&,
                                FlightRecord&) const;
template void Flight::fly_plant(internal::NonlinearPlant<RigidDynamics>, internal::ModifiedPath,
                                const Eigen::Ref<const Eigen::MatrixX3d>&, const TrialSeed&,
                                FlightRecord&) const;
template void Flight::fly_plant(internal::NonlinearPlant<AdditionalDynamics>, internal::ModifiedPath,
                                const Eigen::Ref<const Eigen::MatrixX3d>&, const TrialSeed&,
                                FlightRecord&) const;
template void Flight::fly_plant(internal::NonlinearPlant<AdditionalDynamics>, internal::DirectPath,
                                const Eigen::Ref<const Eigen::MatrixX3d>&, const TrialSeed&,
                                FlightRecord&) const;

}  // namespace fatmc
