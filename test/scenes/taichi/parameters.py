import numpy as np                                # python 用の数値計算ライブラリ

SimulationTime = 2.0                              # [s] シミュレーション実行時間
CalculationSpace = 0.6                            # [m] 立方体の計算空間の一辺
Resolution = 128                                  # 計算空間の格子の解像度
gravity = ( 0.0, 0.0, -9.81 )                     # 重力
dt = 1e-4                                         # 時間刻み
myu = 0.3                                         # 摩擦係数
airresistance = 1.0                               # c, 空気抵抗の意味合い. v* = e^{(c*dt)}
VTUinterval = 20                                  # VTU saving interval
epsilon = 0.1                                     # restitution coefficient 反発係数

apple = {                                         # リンゴの定義
    "fileName": 'scenes/apple_cut_seed/apple.obj',
    "translation": [CalculationSpace/2.0, CalculationSpace/2.0, 0.075], # CAD 座標系から計算座標系へ
    "scale": [1, 1, 1],                           # x, y, z スケール
    "mass": 0.2,                                  # 質量
}

knife = {                                         # ナイフの定義
    "fileName": 'scenes/apple_cut_seed/knife2.obj',
    "translation": [CalculationSpace/2.0+0.1, CalculationSpace/2.0, CalculationSpace/2.0-0.06], # CAD 座標系から計算座標系へ
    "scale": [1, 1, 1],
    "COGx": [0, 0, 0],
    "COGy": [0, 0, 0],
    "mass": 0.2,
    "inertia": [[1,0,0],[0,1,0],[0,0,1]], # 慣性テンソル, 使っていない
}
