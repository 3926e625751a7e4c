-- Pushes, then holds the height.
function control(t, body)
    if body.phase == 1 and t < 0.02 then
        return { force = { -params.force, 0, 0 }, torque = { 0, 0.001, 0 } }
    end
    return { phase = 2, hold = "z" }
end
