function place(t) return params.way*math.sin(20*t), 0, 0 end
