// Turns the body of an MJCF file at rates that grow with time, in MuJoCo for JavaScript, and prints what its gyro shows:
//
//     node turned_gyro.mjs PACKAGE_FOLDER BODY.xml SECONDS
//
// One line of JSON: {"version": ..., "rows": [[time_s, x, y, z], ...]}, in rad/s. The true rates are (1, -2, 3) rad/s a
// second.
import {readFileSync} from 'node:fs';
import {pathToFileURL} from 'node:url';

const [folder, path, seconds] = process.argv.slice(2);
const {default: load} = await import(pathToFileURL(`${folder}/mujoco.js`));
const mujoco = await load();
const model = mujoco.MjModel.from_xml_string(readFileSync(path, 'utf8'));
const data = new mujoco.MjData(model);
const rows = [];
while (data.time < Number(seconds)) {
    const time_s = data.time;
    data.qvel.set([time_s, -2 * time_s, 3 * time_s], 3);
    mujoco.mj_step(model, data);  // its sensors show the beginning of the step
    rows.push([time_s, ...data.sensordata]);
}
console.log(JSON.stringify({version: mujoco.mj_versionString(), rows}));
process.exit(0);
