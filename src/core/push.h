/* Keeps fluid particles outside bodies, whatever the step has done. */
#pragma once

struct tobi_system;
/* Puts particles outside again that the bodies' new poses have caught, that came nearer than 0.2 d, or that
   went through a body within the step, however thin it is. Their speed into the body is taken, the impulse
   counts as pressure of this system's load. After tobi_near_measure and the motion of particles and bodies;
   counts in s->near.contacts. */
void tobi_push_out(struct tobi_system *s);
