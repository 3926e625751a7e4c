/* The columns of history.csv, bodies.csv, solids.csv, probes.csv, lines.csv, joints.csv, porous_zones.csv and
   scalars.csv: name, unit, value, meaning. One line makes the header, the row, `tobiuo describe history` and
   docs/tables.md, so that they cannot disagree. Drawback: values are expressions, which mean something only
   in the writers. */
#pragma once

/* H(name, unit, kind, value, meaning): history.csv. `i` is the last step's info, `s` the sums since the last
   output, `e` the energies of bodies and springs, `pieces` those of the solids. */
#define HISTORY(H) \
    H("time", "s", real, i->time, "Simulated time.") \
    H("step", "1", int, i->step, "Number of the last step, from 1; 0 at the start.") \
    H("dt", "s", real, i->dt, "Length of the last step.") \
    H("density_iterations", "1", int, i->density_iterations, \
      "Iterations of the density solve; 0 of a method without a solver.") \
    H("density_iterations_mean", "1", real, mean(s->density_iterations, s), \
      "Their mean over the steps since the last output.") \
    H("divergence_iterations", "1", int, i->divergence_iterations, "Iterations of the velocity solve.") \
    H("divergence_iterations_mean", "1", real, mean(s->divergence_iterations, s), \
      "Their mean over the steps since the last output.") \
    H("viscosity_iterations", "1", int, i->viscosity_iterations, \
      "Iterations of implicit viscosity in the last step; 0 without it.") \
    H("unconverged_steps", "1", int, s->unconverged, \
      "Steps since the last output in which a solver stopped short of its tolerance; 0 is expected.") \
    H("density_error_mean", "1", real, i->density_error_mean, \
      "Mean over all fluid of abs(density/rest density - 1); above 0.02 it is wrong.") \
    H("density_error_max", "1", real, i->density_error_max, "Its largest value at a particle.") \
    H("surface_share", "1", real, i->surface_share, \
      "Share of the fluid's particles at a free surface, 0 to 1; above 0.5 most is spray.") \
    H("divergence_mean", "1/s", real, i->divergence_mean, \
      "Mean over all fluid of abs(div v) after the velocity solve.") \
    H("divergence_max", "1/s", real, i->divergence_max, "Its largest value at a particle.") \
    H("divergence_step", "1", real, i->divergence_max*i->dt, \
      "divergence_max times dt: the largest change of volume that the last step leaves.") \
    H("pressure_residual", "1", real, i->pressure_residual, \
      "Relative residual of the pressure in the last step; of dfsph in the density solve.") \
    H("pressure_residual_max", "1", real, s->residual_max, \
      "Its largest value since the last output; of isph, recomputed from the solution.") \
    H("volume_drift", "1", real, i->volume_drift, \
      "Mean error of volume away from a free surface, positive: swollen; of isph, 0 of the others.") \
    H("wall_force_x", "N", real, i->wall_force[0], \
      "Force of the fluid on the sides of the domain; positive pushes towards +. Still water " \
      "presses the floor by its weight, downwards.") \
    H("wall_force_y", "N", real, i->wall_force[1], "") \
    H("wall_force_z", "N", real, i->wall_force[2], "") \
    H("weight", "N", real, i->weight, "Mass times gravity of all fluid.") \
    H("wall_force_ratio", "1", real, wall_ratio(run, i), \
      "Wall force along gravity over the weight; 1 in a tank at rest without bodies.") \
    H("kinetic_energy", "J", real, i->kinetic_energy, "Of all fluid and solids.") \
    H("potential_energy", "J", real, i->potential_energy, \
      "In gravity, against the lower corner of the domain.") \
    H("body_kinetic_energy", "J", real, e->kinetic, \
      "Of all bodies that move by forces, of the turn, too; each: bodies.csv.") \
    H("body_potential_energy", "J", real, e->potential, "Theirs, in gravity, against the lower corner.") \
    H("spring_energy", "J", real, e->springs, \
      "In springs of joints, hinges and guides, and in lines, with the weight of catenaries.") \
    H("motion_work", "J", real, tobi_works_bodies(run, TOBI_BY_MOTION), \
      "Done by motions of bodies on fluids and solids, by swimmers also on themselves, since the start.") \
    H("joint_work", "J", real, tobi_works_joints(run), \
      "Taken from bodies by dampers and motors of joints since the start; below 0: motors drive.") \
    H("line_work", "J", real, run->works.lines, "Taken by the damping of lines since the start.") \
    H("force_work", "J", real, tobi_works_bodies(run, TOBI_BY_FORCE), \
      "Done on bodies by their constant forces and torques and by control programs since the start.") \
    H("elastic_energy", "J", real, i->elastic_energy, "Stored in solids and compressed liquids of mlsmpm.") \
    H("work_bodies", "J", real, i->work_bodies, \
      "Done by bodies and fluids on the solids since the start; positive: the solids gain.") \
    H("energy_lost", "J", real, i->energy_lost, \
      "Lost by the solids since the start; the seven columns that follow are its parts.") \
    H("transfer_dissipation", "J", real, i->transfer_dissipation, \
      "Lost on the way to the grid and back; 0 without mlsmpm.measure_transfer.") \
    H("plastic_work", "J", real, i->plastic_work, \
      "Lost to plastic flow and viscosity; 0 without mlsmpm.measure_transfer.") \
    H("step_work", "J", real, i->step_work, \
      "Lost to the length of time steps, impact included; 0 without mlsmpm.measure_transfer.") \
    H("damping_work", "J", real, i->damping_work, "Lost to the damping of solids.") \
    H("friction_work", "J", real, i->friction_work, \
      "Lost to friction and impact at bodies and at faces of cuts.") \
    H("fracture_work", "J", real, i->fracture_work, "Lost to new surface, by blades and by cracks.") \
    H("side_work", "J", real, i->side_work, \
      "Lost to friction at sides of the domain; negative where sides drive.") \
    H("momentum_x", "kg m/s", real, i->momentum[0], "Of all fluid and solids.") \
    H("momentum_y", "kg m/s", real, i->momentum[1], "") \
    H("momentum_z", "kg m/s", real, i->momentum[2], "") \
    H("force_sum", "N", real, i->force_sum, \
      "Sum over particles of the size of their force: the scale of errors in momentum.") \
    H("speed_max", "m/s", real, i->speed_max, "Speed of the fastest particle.") \
    H("fluid_particles", "1", int, i->fluid_particles, "Particles of fluid and solids.") \
    H("mass_in", "kg", real, i->mass_in, \
      "Mass that inlets have let into the domain, buffers included, since the start.") \
    H("mass_out", "kg", real, i->mass_out, "Mass that outlets have taken away since the start.") \
    H("mass_held", "kg", real, i->mass_held, \
      "Mass of all fluid and solids: what it was at the start, plus mass_in, less mass_out.") \
    H("particles_lost", "1", int, i->particles_lost, "Particles that left the domain since the start.") \
    H("put_back", "1", int, i->put_back, \
      "Times since the start that a particle of mlsmpm was put back into the domain.") \
    H("capped", "1", int, i->capped, "Particles that were slowed to the largest speed in the last step.") \
    H("contacts", "1", int, i->contacts, \
      "Particles that a surface held back by their position in the last step.") \
    H("pieces", "1", int, pieces->count, "Connected pieces of the solids.") \
    H("fragments", "1", int, pieces->fragments, "Pieces of fewer particles than a grid cell holds.")

/* The last column of history.csv, which it has with porous zones alone. */
#define HISTORY_POROUS(H) \
    H("porous_work", "J", real, tobi_works_porous(run), \
      "Taken from liquids by porous zones since the start, where there are any.")

/* The same with temperature or concentration that changes the weight, behind it. */
#define HISTORY_BUOYANCY(H) \
    H("buoyancy_work", "J", real, run->works.buoyancy, \
      "Given to liquids since the start by what temperature and concentration change of their weight, " \
      "where they do.")

/* The same with bodies that feel air, and with those that a frame, gravity in time or a central force
   moves. */
#define HISTORY_AIR(H) \
    H("air_work", "J", real, tobi_works_bodies(run, TOBI_BY_AIR), \
      "Done on bodies by their air_resistance since the start, below 0; where there is any.")
#define HISTORY_FIELD(H) \
    H("field_work", "J", real, tobi_works_bodies(run, TOBI_BY_FIELD), \
      "Done on bodies since the start by what acts besides gravity: a frame that moves, gravity in time, a " \
      "central force; where there is any.")

#define HISTORY_NEST(H) \
    H("nest_work", "J", real, tobi_works_bodies(run, TOBI_BY_NEST), \
      "Done on bodies since the start by what nests press them with more than the liquid here; where nests " \
      "move bodies.")

/* B(name, unit, value, meaning): bodies.csv after time and name, all real; V3 for a vector. An empty meaning:
   that of the column before. Means are over the time since the last output. */
#define V3(B, name, unit, v, doc) \
    B(name "_x", unit, v[0], doc) B(name "_y", unit, v[1], "") B(name "_z", unit, v[2], "")
#define BODY(B) \
    V3(B, "position", "m", b.position, "Centre of mass.") \
    B("orientation_w", "1", b.orientation[0], \
      "Unit quaternion against the rest pose: cosine of half the turn.") \
    B("orientation_x", "1", b.orientation[1], "Its axis times the sine of half the turn.") \
    B("orientation_y", "1", b.orientation[2], "") \
    B("orientation_z", "1", b.orientation[3], "") \
    V3(B, "velocity", "m/s", b.velocity, "Of the centre of mass.") \
    V3(B, "angular_velocity", "rad/s", b.angular_velocity, "By the right-hand rule, in axes of the domain.") \
    V3(B, "pressure_force", "N", b.pressure_force, \
       "Of the particles on the body along its normals, in the last step; positive pushes towards +.") \
    V3(B, "viscous_force", "N", b.viscous_force, "Of the particles along its surface, in the last step.") \
    V3(B, "pressure_torque", "N m", b.pressure_torque, "About the centre of mass, of pressure_force.") \
    V3(B, "viscous_torque", "N m", b.viscous_torque, "About the centre of mass, of viscous_force.") \
    V3(B, "mean_pressure_force", "N", m.impulse[0], \
       "Mean of pressure_force over the time since the last output: the one to plot.") \
    V3(B, "mean_viscous_force", "N", m.impulse[1], "Mean of viscous_force over that time.") \
    V3(B, "mean_pressure_torque", "N m", m.impulse[2], "Mean of pressure_torque over that time.") \
    V3(B, "mean_viscous_torque", "N m", m.impulse[3], "Mean of viscous_torque over that time.") \
    V3(B, "contact_force", "N", b.contact_force, "Of bodies and sides that touch it, in the last step.") \
    V3(B, "contact_torque", "N m", b.contact_torque, "About the centre of mass, of contact_force.") \
    V3(B, "mean_contact_force", "N", m.impulse[4], "Mean of contact_force over that time.") \
    V3(B, "mean_contact_torque", "N m", m.impulse[5], "Mean of contact_torque over that time.") \
    V3(B, "edge_force", "N", b.edge_force, \
       "The part of pressure_force that the edge of a blade takes to cut, in the last step.") \
    V3(B, "mean_edge_force", "N", m.impulse[6], "Mean of edge_force over that time.") \
    B("kinetic_energy", "J", e.kinetic, "Of the centre of mass and of the turn; 0 of a prescribed body.") \
    B("potential_energy", "J", e.potential, \
      "In gravity, against the lower corner of the domain; 0 of a prescribed body.") \
    B("work", "J", work[TOBI_BY_PARTICLES], \
      "Done on it by fluids and solids since the start: by pressure_force, viscous_force and their " \
      "torques, and by what a change of its shape adds.") \
    B("contact_work", "J", work[TOBI_BY_CONTACT], \
      "Done on it by bodies and sides that touch it since the start.") \
    B("motion_work", "J", work[TOBI_BY_MOTION], \
      "Given by its motion since the start: of a prescribed body what fluids and solids take; of a swimmer " \
      "what its change of shape gives to all that it touches, and to its turn.") \
    B("force_work", "J", work[TOBI_BY_FORCE], \
      "Done on it by force and torque of the scene and by those of its control program since the start.")

/* The last columns of bodies.csv: those of 2-D or of 3-D, those of air resistance, those of a frame and the
   like, those of nests. */
#define BODY_2D(B) \
    B("angle", "degrees", run->works.angle[k]*180/acos(-1), \
      "Turn since the rest pose, counterclockwise, with whole turns; in 2-D.")
#define BODY_3D(B) \
    B("roll", "degrees", turn[0], \
      "Turn about x since the rest pose, the first of three, as in keyframes; in 3-D.") \
    B("pitch", "degrees", turn[1], "The turn after it, about y: positive lowers what lies ahead along x.") \
    B("yaw", "degrees", turn[2], "The last turn, about z.")
#define BODY_AIR(B) \
    B("air_work", "J", work[TOBI_BY_AIR], \
      "Done on it by its air_resistance since the start, below 0; where there is any.")
#define BODY_FIELD(B) \
    B("field_work", "J", work[TOBI_BY_FIELD], \
      "Done on it since the start by a frame that moves, gravity in time and a central force; where there " \
      "is any.")
#define BODY_NEST(B) \
    V3(B, "nest_force", "N", finer, \
       "What a nest pressed it with more than pressure_force and viscous_force, mean of the last steps; it " \
       "moves the body too; where nests move bodies.") \
    V3(B, "nest_torque", "N m", (finer + 3), "About the centre of mass, of nest_force.") \
    B("nest_work", "J", work[TOBI_BY_NEST], "Done on it by nest_force and nest_torque since the start.")

/* S(name, unit, value, meaning): solids.csv after time and name, likewise. */
#define SOLID(S) \
    V3(S, "position", "m", i.centre, "Centre of mass.") \
    V3(S, "velocity", "m/s", i.velocity, "Of the centre of mass.")
/* Beside fluids. */
#define SOLID_LIQUID(S) \
    V3(S, "liquid_force", "N", i.liquid_force, \
       "Of the fluids on the solid, pressure and friction, in the last step; positive pushes towards +; " \
       "where there are any.") \
    V3(S, "mean_liquid_force", "N", m, \
       "Mean of liquid_force over the time since the last output: the one to plot.")

/* P(name, unit, meaning): what a point and a level measure. */
#define POINT(P) \
    P("pressure", "Pa", "Pressure at the point; 0 where there is no fluid.") \
    P("velocity_x", "m/s", "Velocity of the fluid at the point.") \
    P("velocity_y", "m/s", "") \
    P("velocity_z", "m/s", "") \
    P("temperature", "degC", \
      "Of the fluid at the point, where `scalars` has it; 0 where there is no fluid.") \
    P("concentration", "1", "Likewise.")
#define LEVEL(P) \
    P("level", "m", \
      "Coordinate of the free surface on the plumb line of the point: y or z if gravity is along -y or -z.")
#define PATCH(P) \
    P("pressure", "Pa", "Mean pressure on the rectangle.") \
    P("force_x", "N", "Force of the fluid on it.") \
    P("force_y", "N", "") \
    P("force_z", "N", "") \
    P("moment_x", "N m", "Moment of that force about the middle of the rectangle.") \
    P("moment_y", "N m", "") \
    P("moment_z", "N m", "")
#define RUN_UP(P) \
    P("run_up", "m", "Coordinate, along gravity, of the place on the line where the water ends.") \
    P("distance", "m", "How far that place is from the begin of the line; 0 where it is dry.")
#define FLOW(P) \
    P("flow", "m3/s", "Discharge: volume per second through the rectangle, positive along its normal.")
#define VOLUME(P) \
    P("volume", "m3", "Volume of liquid in the box.")

/* V(name, unit, value, meaning): lines.csv after time, for each line; `i` is its info. */
#define LINE(V) \
    V("tension", "N", i.tension, "Force along the line; positive pulls.") \
    V("distance", "m", i.distance, "Distance of its ends.")

/* V(name, unit, value, meaning), SOLID of those that a joint in 2-D has not: joints.csv, likewise. */
#define JOINT(V, SOLID) \
    V("force_x", "N", i.force[0], "Force of the joint on its body.") \
    V("force_y", "N", i.force[1], "") \
    SOLID("force_z", "N", i.force[2], "") \
    SOLID("moment_x", "N m", i.moment[0], "Moment of the joint on its body.") \
    SOLID("moment_y", "N m", i.moment[1], "") \
    V("moment_z", "N m", i.moment[2], "") \
    V("angle", "degrees", i.angle, "Angle of body against to_body since the start.") \
    V("position", "m", i.position, "Of a guide or slide: way of the body along the axis since the start.") \
    V("gap", "m", i.gap, "Distance of the two points that the joint holds together; of a slide across it.") \
    V("motor_torque", "N m", i.motor_torque, \
      "Torque of its motor about the axis on its body, where it has one.") \
    V("motor_force", "N", i.motor_force, "The same of a guide or slide: its force along the axis.") \
    V("power", "W", i.power, \
      "Taken from the bodies by damper and motor, where it has any; below 0 the motor drives.") \
    V("work", "J", run->works.joint[k], "Sum of power times time since the start.")

/* V(name, unit, value, meaning): porous_zones.csv after time, for each zone; `i` is its info. */
#define POROUS(V) \
    V("force_x", "N", i.force[0], "Force of the liquid on the contents of the zone, in the last step.") \
    V("force_y", "N", i.force[1], "") \
    V("force_z", "N", i.force[2], "") \
    V("power", "W", i.power, "Taken from the liquid, in the last step.") \
    V("work", "J", run->works.porous[k], "Sum of power times time since the start.") \
    V("volume", "m3", i.volume, "Of the liquid in the zone, as if its contents took no room.")

/* V(name, unit, value, meaning): scalars.csv after time, for temperature and for concentration; `i` is its
   info. Amounts are in kg where nothing has a heat capacity. */
#define SCALAR(V) \
    V("min", "degC", i.least, "Least value of the particles.") \
    V("mean", "degC", i.mean, "Their mean, by mass.") \
    V("max", "degC", i.most, "Largest value of the particles.") \
    V("amount", "J", i.amount, "What the liquids have beyond the value at the start; kg of a concentration.")

/* The same for each side and body with a value or a flux; `f` is its flow. */
#define SCALAR_FLOW(V) \
    V("flow", "W", f.flow, \
      "What comes through the side or body into the liquid, in the last step; kg/s of a concentration.") \
    V("passed", "J", run->works.scalar[k], "Sum of flow times time since the start.") \
    V("value", "degC", f.value, "Of a side or body with a heat capacity alone: the value that it has.")
